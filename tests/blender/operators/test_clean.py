"""What an animator can rely on when pressing Clean."""

import json
import tomllib
from pathlib import Path

import numpy as np
from numpy.testing import assert_allclose

RAW, CLEAN = "walk", "walk.clean"
MANIFEST = Path(__file__).parents[3] / "blender_manifest.toml"


def roughness(keys):
    values = np.array([key[1] for key in keys])
    return np.abs(np.diff(values, n=3)).mean()


def test_result_is_a_new_smoother_action_with_the_same_channels(noisy, clean, keys_of):
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


def test_clean_reports_its_result(noisy, clean):
    result = clean(strength=0.9)

    entry = json.loads(result["mocap_assist_history"])[-1]
    assert (entry["operation"], entry["source"], entry["slot"]) == ("denoise", RAW, "OBActor")
    assert entry["settings"]["strength"] == 0.9
    assert entry["version"] == tomllib.loads(MANIFEST.read_text("utf-8"))["version"]
    assert entry["prior_used"]
    assert entry["after"]["mean_jitter_m_per_s3"] < entry["before"]["mean_jitter_m_per_s3"]


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


def test_results_of_results_are_named_after_the_recording(noisy, clean):
    assert [clean().name for _ in range(3)] == [CLEAN, f"{CLEAN}.001", f"{CLEAN}.002"]


def test_a_strip_is_as_long_as_its_action_between_frames(noisy, clean):
    action = noisy.animation_data.action
    for curve in action.layers[0].strips[0].channelbag(action.slots[0]).fcurves:
        for key in curve.keyframe_points:
            key.co.x += 0.5
        curve.update()

    clean(result_as="NLA_TRACK")

    strip = noisy.animation_data.nla_tracks[0].strips[0]
    assert (strip.frame_start, strip.frame_end, strip.scale) == (1.5, 60.5, 1.0)


def test_only_selected_bones_change(noisy, clean, keys_of, load):
    compat = load("mocap_assist.blender.compat")
    before = keys_of(noisy.animation_data.action)
    for bone in noisy.pose.bones:
        compat.select_bone(bone, bone.name == "Head")

    after = keys_of(clean(bones="SELECTED"))

    changed = {
        path for (slot, path, index), keys in after.items() if keys != before[slot, path, index]
    }
    assert changed == {'pose.bones["Head"].rotation_euler'}


def test_cleaning_parts_one_by_one_keeps_the_clean_parts(noisy, clean, keys_of, blank):
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


def test_half_strength_is_halfway(noisy, clean, keys_of, blank):
    raw = keys_of(noisy.animation_data.action)
    path = "OBActor", 'pose.bones["Head"].rotation_euler', 2
    values = [np.array([key[1] for key in raw[path]])]
    for strength in (0.5, 1.0):
        values.append(np.array([key[1] for key in keys_of(clean(strength=strength))[path]]))
        blank.ops.mocap_assist.revert_to_raw()

    assert_allclose(values[1], (values[0] + values[2]) / 2, atol=2e-3)


def test_filled_and_corrected_keys_are_marked_by_bone_and_frame(noisy, clean, keys_of):
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


def test_clean_is_one_undo_step(noisy, clean, blank):
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
    cleaning = load("mocap_assist.clean.solve_cleaning")
    monkeypatch.setattr(cleaning, "solve", lambda *_, **__: solved.append(1))

    clean(strength=0.8, result_as="NLA_TRACK")

    assert not solved


def test_noise_outside_the_range_stays(noisy, clean, blank, capfd):
    scene, action = blank.context.scene, noisy.animation_data.action
    path = 'pose.bones["Head"].rotation_euler'

    def head(action):
        bag = action.layers[0].strips[0].channelbag(action.slots[0])
        return bag.fcurves.find(path, index=0)

    head(action).modifiers.new("NOISE").strength = 0.5
    scene.frame_start, scene.frame_end = 1, 30

    result = clean(frame_range="SCENE")

    outside = range(31, 61)
    assert_allclose(
        [head(result).evaluate(frame) for frame in outside],
        [head(action).evaluate(frame) for frame in outside],
        atol=1e-5,
    )
    assert "Applied the modifiers of 1 curves." in capfd.readouterr().out


def test_bone_locations_get_nearer_to_the_truth(make_armature, animate, clean, rng):
    armature = make_armature()
    action = animate(armature, range(1, 91), locations=True)

    def locations(action):
        bag = action.layers[0].strips[0].channelbag(action.slots[0])
        return {
            (curve.data_path, curve.array_index): curve.keyframe_points
            for curve in bag.fcurves
            if curve.data_path.endswith("location")
            and not armature.pose.bones[curve.data_path.split('"')[1]].bone.use_connect
        }

    truth = {name: [key.co.y for key in keys] for name, keys in locations(action).items()}
    for keys in locations(action).values():
        for key in keys:
            key.co.y += rng.normal(scale=0.02)

    after = locations(clean())

    errors = {
        name: np.std(np.array([key.co.y for key in after[name]]) - values)
        for name, values in truth.items()
    }
    assert len(errors) >= 15 and max(errors.values()) < 0.015


def test_arm_that_a_tracker_held_moves_on(noisy, clean):
    """Fifteen frames that repeat the one before are filled, and painted as filled."""
    action, lost = noisy.animation_data.action, range(20, 35)
    curves = action.layers[0].strips[0].channelbag(action.slots[0]).fcurves
    arm = ('pose.bones["RightArm"]', 'pose.bones["RightForeArm"]')
    held = [each for each in curves if each.data_path.startswith(arm)]
    assert len(held) == 6
    for curve in held:
        for index in lost:
            curve.keyframe_points[index].co.y = curve.keyframe_points[19].co.y
        curve.update()

    result = clean()

    after = result.layers[0].strips[0].channelbag(result.slots[0]).fcurves
    moved = [after.find(each.data_path, index=each.array_index) for each in held]
    spread = [np.ptp([each.keyframe_points[index].co.y for index in lost]) for each in moved]
    assert max(spread) > 0.02
    painted = [each.keyframe_points[index].type for each in moved for index in lost]
    assert painted.count("GENERATED") > 0.6 * len(painted)
