"""What guides Clean besides the take: contacts, limits and examples."""

import json

import numpy as np
import pytest


def test_edited_contacts_are_used_and_preserved(noisy, clean, blank, load):
    contacts = load("mocap_assist.actions.contact_keys")
    frames = np.arange(1.0, 61.0)
    first = clean(plant_feet=True)
    found = contacts.read_contacts(first, first.slots[0], frames)
    assert found.shape == (60, 2)
    keyed = np.zeros((60, 2), bool)
    keyed[10:20, 0] = True
    contacts.write_contacts(noisy, first, first.slots[0], frames, keyed)

    second = clean(plant_feet=True)

    assert second != first
    stored = contacts.read_contacts(second, second.slots[0], frames)
    assert (stored == keyed).all()
    left = load("mocap_assist.actions.armature_read").read_take(noisy, blank.context.scene)
    kinematics = load("solvers.motion.skeletons.kinematics")
    motion = left.parts[0].motion
    foot = kinematics.forward_kinematics(motion).positions[
        10:20, motion.skeleton.index("LeftFoot_end")
    ]
    assert np.ptp(foot[:, :2], axis=0).max() < 1e-3


def test_keyed_hand_stays_in_place_and_keeps_its_keys(walker, load, blank, keys_of):
    """No hand of a walk is found in contact, so that only the field is there to be keyed."""
    contacts = load("mocap_assist.actions.contact_keys")
    played = {"frames": np.arange(1.0, walker.animation_data.action.frame_range[1] + 1.0)}
    blank.ops.mocap_assist.plant_feet()
    first = walker.animation_data.action
    assert contacts.read_contacts(first, first.slots[0], **played).shape[1] == 2
    for frame, value in ((30, 1), (35, 0)):
        walker["mocap_contact_left_hand"] = value
        walker.keyframe_insert('["mocap_contact_left_hand"]', frame=frame)

    blank.ops.mocap_assist.plant_feet()

    second = walker.animation_data.action
    stored = contacts.read_contacts(second, second.slots[0], **played)
    assert np.flatnonzero(stored[:, 2]).tolist() == [29, 30, 31, 32, 33]
    assert not stored[:, 3:].any()
    before, after = keys_of(first), keys_of(second)
    moved = {name[1].split('"')[1] for name, keys in after.items() if keys != before.get(name)}
    assert "LeftForeArm" in moved and "RightForeArm" not in moved


def test_edited_contacts_stay_when_other_frames_are_cleaned(walker, clean, load, blank):
    contacts = load("mocap_assist.actions.contact_keys")
    scene = blank.context.scene
    scene.frame_start, scene.frame_end = 1, 45
    first = clean(plant_feet=True, frame_range="SCENE")
    bag = first.layers[0].strips[0].channelbag(first.slots[0])
    curve = bag.fcurves.find('["mocap_contact_left"]', index=0)
    curve.keyframe_points[0].co.y = 1.0 - curve.keyframe_points[0].co.y
    curve.update()
    scene.frame_start, scene.frame_end = 46, 90

    both = clean(plant_feet=True, frame_range="SCENE")

    stored = contacts.animators_contacts((both, both.slots[0]), np.arange(1.0, 91.0))
    mine = contacts.animators_contacts((first, first.slots[0]), np.arange(1.0, 46.0))
    assert np.isfinite(mine[0, 0]) and np.isnan(stored[45:]).all()
    np.testing.assert_array_equal(stored[:45], mine)


def test_clean_respects_limit_constraints(noisy, clean, blank, keys_of):
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
    with pytest.raises(RuntimeError, match=r"No action or file is named nowhere\.bvh"):
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
