"""What an animator can rely on when pressing Clean."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose

RAW, CLEAN = "walk", "walk.clean"


@pytest.fixture
def noisy(make_armature, animate, blank, rng):
    """A figure of 13 bones in smooth motion with 2 degrees of noise, for two seconds."""
    armature = make_armature(mode="XYZ")
    action = animate(armature)
    blank.context.scene.render.fps = 30
    bag = action.layers[0].strips[0].channelbag(action.slots[0])
    for curve in bag.fcurves:
        scale = 0.01 if "location" in curve.data_path else np.radians(2.0)
        for key in curve.keyframe_points:
            key.co.y += rng.normal(scale=scale)
        curve.update()
    return armature


@pytest.fixture
def clean(blank):
    """Press Clean; without feet, so that the random dance of the figure is not nailed down."""

    def press(**settings):
        settings = {"plant_feet": False} | settings
        assert blank.ops.mocap_assist.denoise(**settings) == {"FINISHED"}
        return blank.context.object.animation_data.action

    return press


def roughness(keys):
    values = np.array([key[1] for key in keys])
    return np.abs(np.diff(values, n=3)).mean()


def test_the_result_is_a_new_calmer_action_with_the_same_channels(noisy, clean, keys_of):
    raw = noisy.animation_data.action
    before = keys_of(raw)

    result = clean()

    after = keys_of(result)
    assert (raw.name, result.name) == (RAW, CLEAN)
    assert keys_of(raw) == before
    assert after.keys() == before.keys()
    assert noisy.animation_data.action_slot.identifier == "OBActor"
    calmer = [roughness(after[name]) < 0.5 * roughness(before[name]) for name in before]
    assert np.mean(calmer) > 0.9


def test_it_says_what_was_done(noisy, clean):
    result = clean(strength=0.9)

    entry = json.loads(result["mocap_assist_history"])[-1]
    assert (entry["operation"], entry["source"], entry["slot"]) == ("denoise", RAW, "OBActor")
    assert entry["settings"]["strength"] == 0.9
    assert entry["version"] == "0.1.0"
    assert entry["prior_used"]
    assert entry["after"]["mean_jitter_m_per_s3"] < entry["before"]["mean_jitter_m_per_s3"]


def test_revert_plays_the_raw_action_again_and_keeps_the_result(noisy, clean, blank):
    with pytest.raises(RuntimeError, match="Actor plays no result of Mocap Assist"):
        blank.ops.mocap_assist.revert_to_raw()
    raw, result = noisy.animation_data.action, clean()
    raw.name = "renamed by the animator"

    assert blank.ops.mocap_assist.revert_to_raw() == {"FINISHED"}

    assert noisy.animation_data.action == raw
    assert noisy.animation_data.action_slot == raw.slots[0]
    assert result.use_fake_user


def test_a_result_on_an_nla_track_moves_the_bones_and_can_be_reverted(
    noisy, clean, blank, poses
):
    clean()
    expected = poses(noisy, [20])["Head"]
    blank.ops.mocap_assist.revert_to_raw()

    assert clean(result_as="NLA_TRACK") is None

    assert_allclose(poses(noisy, [20])["Head"], expected, atol=1e-5)
    blank.ops.mocap_assist.revert_to_raw()
    assert noisy.animation_data.action.name == RAW
    assert not noisy.animation_data.nla_tracks


def test_only_selected_bones_change(noisy, clean, keys_of, load):
    compat = load("mocap_assist.scene.compat")
    before = keys_of(noisy.animation_data.action)
    for bone in noisy.pose.bones:
        compat.select_bone(bone, bone.name == "Head")

    after = keys_of(clean(bones="SELECTED"))

    changed = {
        path for (slot, path, index), keys in after.items() if keys != before[slot, path, index]
    }
    assert changed == {'pose.bones["Head"].rotation_euler'}


def test_nothing_selected_is_said(noisy, clean, load):
    compat = load("mocap_assist.scene.compat")
    for bone in noisy.pose.bones:
        compat.select_bone(bone, False)

    with pytest.raises(RuntimeError, match=r"No bones are selected\. Select some in Pose Mode"):
        clean(bones="SELECTED")


def test_cleaning_part_by_part_keeps_the_parts_already_clean(noisy, clean, keys_of, blank):
    scene = blank.context.scene
    scene.frame_start, scene.frame_end = 1, 30
    first = keys_of(clean(frame_range="SCENE"))
    scene.frame_start, scene.frame_end = 31, 60

    second = keys_of(clean(frame_range="SCENE"))

    path = "OBActor", 'pose.bones["Head"].rotation_euler', 0
    assert [key[:2] for key in first[path][:30]] == [key[:2] for key in second[path][:30]]
    assert [key[:2] for key in first[path][30:]] != [key[:2] for key in second[path][30:]]
    blank.ops.mocap_assist.revert_to_raw()
    assert blank.context.object.animation_data.action.name == RAW


def test_a_cleaned_range_joins_the_rest_without_a_step(noisy, clean, keys_of, blank):
    scene = blank.context.scene
    raw = keys_of(noisy.animation_data.action)
    scene.frame_start, scene.frame_end = 20, 40

    after = keys_of(clean(frame_range="SCENE"))

    for name, keys in after.items():
        moved = np.array([key[1] for key in keys]) - [key[1] for key in raw[name]]
        assert not moved[:19].any() and not moved[40:].any()
        assert abs(moved[19]) <= abs(moved).max() / 2


def test_half_the_strength_goes_half_the_way(noisy, clean, keys_of, blank):
    raw = keys_of(noisy.animation_data.action)
    path = "OBActor", 'pose.bones["Head"].rotation_euler', 2
    values = [np.array([key[1] for key in raw[path]])]
    for strength in (0.5, 1.0):
        values.append(np.array([key[1] for key in keys_of(clean(strength=strength))[path]]))
        blank.ops.mocap_assist.revert_to_raw()

    assert_allclose(values[1], (values[0] + values[2]) / 2, atol=2e-3)


def test_filled_and_corrected_keys_are_marked_per_bone_and_frame(noisy, clean, keys_of):
    action = noisy.animation_data.action
    bag = action.layers[0].strips[0].channelbag(action.slots[0])
    for curve in bag.fcurves:
        if "LeftArm" in curve.data_path:
            for key in list(curve.keyframe_points)[20:30][::-1]:
                curve.keyframe_points.remove(key)

    after = keys_of(clean())

    arm = [key[-1] for key in after["OBActor", 'pose.bones["LeftArm"].rotation_euler', 0]]
    head = [key[-1] for key in after["OBActor", 'pose.bones["Head"].rotation_euler', 0]]
    assert len(arm) == 60 and arm[20:30] == ["GENERATED"] * 10
    assert arm.count("KEYFRAME") >= 40 and head.count("KEYFRAME") >= 50


def test_undo_is_one_step(noisy, clean, blank):
    window = blank.context.window_manager.windows[0]
    with blank.context.temp_override(window=window, screen=window.screen):
        blank.ops.ed.undo_push(message="before")
        clean()
        blank.ops.ed.undo_push(message="Clean")
        blank.ops.ed.undo()

    assert blank.data.objects["Actor"].animation_data.action.name == RAW
    assert CLEAN not in blank.data.actions


def test_the_redo_panel_does_not_solve_again(noisy, clean, load, monkeypatch, blank):
    clean(strength=0.5)
    blank.ops.mocap_assist.revert_to_raw()
    solved = []
    cleaning = load("mocap_assist.jobs.cleaning")
    monkeypatch.setattr(cleaning, "solve", lambda *_, **__: solved.append(1))

    clean(strength=0.8, result_as="NLA_TRACK")

    assert not solved


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


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (lambda bpy, rig: setattr(rig.animation_data, "action", None), "Actor has no action"),
        (
            lambda bpy, rig: setattr(bpy.context.view_layer.objects, "active", None),
            "Select an armature that plays a captured action",
        ),
        (
            lambda bpy, rig: (
                rig.animation_data.action.layers[0].strips[0].channelbags[0].fcurves.clear()
            ),
            "The action has no keys on this armature's bones",
        ),
    ],
)
def test_bad_input_gives_one_sentence(spoil, sentence, noisy, clean, blank):
    spoil(blank, noisy)

    with pytest.raises(RuntimeError, match=sentence):
        clean()


def test_a_bone_without_keys_stays_as_it_is(noisy, clean, keys_of):
    action = noisy.animation_data.action
    bag = action.layers[0].strips[0].channelbag(action.slots[0])
    for curve in [curve for curve in bag.fcurves if "Spine" in curve.data_path]:
        bag.fcurves.remove(curve)

    assert not any("Spine" in path for _, path, _ in keys_of(clean()))


def test_two_bones_are_enough(make_armature, animate, clean, blank):
    bones = {
        "upper": (None, (0, 0, 0), (0, 0, 1), False),
        "lower": ("upper", (0, 0, 1), (0, 0, 2), True),
    }
    armature = make_armature(bones)
    animate(armature)

    assert clean(plant_feet=True).name == CLEAN


def test_one_frame_is_enough(make_armature, animate, clean, keys_of):
    armature = make_armature(mode="XYZ")
    raw = keys_of(animate(armature, frames=[1]))

    after = keys_of(clean(plant_feet=True))

    for name, keys in after.items():
        if name in raw:
            assert_allclose(
                [key[:2] for key in keys], [key[:2] for key in raw[name]], atol=1e-4
            )


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
