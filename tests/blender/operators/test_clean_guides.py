"""What guides Clean besides the take: contacts, limits and examples."""

import json

import numpy as np
import pytest


def test_the_animators_contacts_are_used_and_kept(noisy, clean, blank, load):
    contacts = load("mocap_assist.scene.contacts")
    frames = np.arange(1.0, 61.0)
    first = clean(plant_feet=True)
    found = contacts.read_contacts(first, first.slots[0], frames)
    assert found.shape == (60, 2)
    keyed = np.zeros((60, 2), bool)
    keyed[10:20, 0] = True
    contacts.write_contacts(noisy, first, first.slots[0], frames, keyed)

    second = clean(plant_feet=True)

    assert second != first
    kept = contacts.read_contacts(second, second.slots[0], frames)
    assert (kept == keyed).all()
    left = load("mocap_assist.scene.armature_read").read_take(noisy, blank.context.scene)
    kinematics = load("solvers.motion.kinematics")
    motion = left.parts[0].motion
    foot = kinematics.forward_kinematics(motion).positions[
        10:20, motion.skeleton.index("LeftFoot_end")
    ]
    assert np.ptp(foot[:, :2], axis=0).max() < 1e-3


def test_limit_constraints_are_kept(noisy, clean, blank, keys_of):
    limit = noisy.pose.bones["Head"].constraints.new("LIMIT_ROTATION")
    limit.owner_space, limit.use_limit_z, limit.min_z, limit.max_z = "LOCAL", True, -0.05, 0.05

    free = keys_of(clean())
    held = keys_of(clean(joint_limits="CONSTRAINTS"))

    path = "OBActor", 'pose.bones["Head"].rotation_euler', 2
    beyond = [max(abs(key[1]) for key in keys[path]) for keys in (free, held)]
    assert beyond[0] > 0.3
    assert beyond[1] < 0.05 + np.radians(5.0) + 1e-6


def test_clean_examples_can_be_actions_of_this_file(noisy, clean, animate, blank):
    raw = noisy.animation_data.action
    example = animate(noisy, frames=range(1, 201))
    example.name = "rehearsal"
    noisy.animation_data.action = raw
    noisy.animation_data.action_slot = raw.slots[0]

    result = clean(prior="EXAMPLES", examples="rehearsal")

    entry = json.loads(result["mocap_assist_history"])[-1]
    assert entry["settings"]["examples"] == "rehearsal"
    assert entry["prior_used"]
    with pytest.raises(RuntimeError, match=r"neither an action nor a file .*nowhere.bvh"):
        clean(prior="EXAMPLES", examples="nowhere.bvh")
    with pytest.raises(RuntimeError, match="Pick clean actions or recordings"):
        clean(prior="EXAMPLES")


def test_limits_can_be_learned_from_the_examples(noisy, clean, animate, keys_of, blank):
    raw = noisy.animation_data.action
    path = "OBActor", 'pose.bones["Head"].rotation_euler', 1
    example = animate(noisy, frames=range(1, 201))
    example.name = "rehearsal"
    bag = example.layers[0].strips[0].channelbag(example.slots[0])
    for index in range(3):
        for key in bag.fcurves.find(path[1], index=index).keyframe_points:
            key.co.y *= 0.1  # in the rehearsal the head hardly moves
    noisy.animation_data.action = raw
    noisy.animation_data.action_slot = raw.slots[0]
    with pytest.raises(RuntimeError, match="Joint limits can only be learned from examples"):
        clean(joint_limits="EXAMPLES")

    examples = {"prior": "EXAMPLES", "examples": "rehearsal"}
    free = keys_of(clean(**examples))[path]
    held = keys_of(clean(joint_limits="EXAMPLES", **examples))[path]

    assert np.ptp([key[1] for key in held]) < 0.9 * np.ptp([key[1] for key in free])
