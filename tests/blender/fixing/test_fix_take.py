"""Fix My Take on takes of each origin, pressed by a script."""

import json

import numpy as np
import pytest
from kinect_walks import tracked_walk, true_positions

CARD = "mocap_assist_fix"


@pytest.fixture
def sample(blank):
    """The armature of the built-in sample take."""
    assert blank.ops.mocap_assist.load_sample() == {"FINISHED"}
    return blank.context.object


@pytest.fixture
def fix(blank, load):
    """Press Fix My Take; return the action that is played then, and its card."""

    def press(**settings):
        assert blank.ops.mocap_assist.fix_take(**settings) == {"FINISHED"}
        selection = load("mocap_assist.runtime.selection")
        action, _ = selection.played_source(selection.selected_subject(blank.context))
        return action, json.loads(action[CARD])

    return press


def values_of(action):
    """All keys of an action."""
    found = {}
    for bag in action.layers[0].strips[0].channelbags:
        for curve in bag.fcurves:
            keys = [tuple(key.co) for key in curve.keyframe_points]
            found[bag.slot_handle, curve.data_path, curve.array_index] = keys
    return found


def test_skeleton_take_gets_a_clean_action_with_planted_feet(sample, fix):
    raw = sample.animation_data.action
    before = values_of(raw)

    action, card = fix()

    assert action.name == "Sample Walk.clean" and values_of(raw) == before
    assert card["origin"] == "suit or file of a skeleton"
    assert card["before"]["jitter_deg"] > 2.0 > 0.2 > card["after"]["jitter_deg"]
    assert (
        card["before"]["longest_foot_slide_cm"]
        > 20
        > 1
        > card["after"]["longest_foot_slide_cm"]
    )
    assert card["after"]["spikes"] == card["after"]["gaps"] == 0
    assert {"mocap_contact_left", "mocap_contact_right"} <= set(sample.keys())


def test_fix_does_what_clean_does(sample, fix, blank):
    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}
    cleaned = values_of(sample.animation_data.action)
    assert blank.ops.mocap_assist.revert_to_raw() == {"FINISHED"}

    fixed, _ = fix()

    for path, keys in values_of(fixed).items():
        np.testing.assert_allclose(cleaned[path], keys, atol=1e-5, err_msg=str(path))


def test_issues_left_are_those_that_check_lists(sample, fix, blank):
    _, card = fix(plant_feet=False)  # so that some are left
    listed = blank.context.scene.mocap_assist
    left = sorted((issue.name, issue.start, issue.kind) for issue in listed.issues)
    assert len(left) == card["after"]["issues"] > 10
    assert listed.checked_action == sample.animation_data.action

    assert blank.ops.mocap_assist.measure_quality() == {"FINISHED"}

    # Keys are rounded: equally long slides may change their order, and 4.45 cm become 4.4.
    assert sorted((each.name, each.start, each.kind) for each in listed.issues) == left


def test_revert_plays_the_recorded_action_and_closes_the_card(sample, fix, blank, draw):
    raw = sample.animation_data.action
    fix()
    assert "mocap_assist.accept_fix" in draw("MOCAP_PT_fix")

    assert blank.ops.mocap_assist.revert_to_raw() == {"FINISHED"}

    assert sample.animation_data.action == raw
    assert "mocap_assist.accept_fix" not in draw("MOCAP_PT_fix")


def test_accept_keeps_the_result_and_closes_the_card(sample, fix, blank, draw):
    action, _ = fix()

    assert "Jitter (°)" not in draw("MOCAP_PT_check")

    assert blank.ops.mocap_assist.accept_fix() == {"FINISHED"}

    assert "Jitter (°)" in draw("MOCAP_PT_check")
    assert sample.animation_data.action == action and CARD not in action
    assert "mocap_assist.accept_fix" not in draw("MOCAP_PT_fix")
    assert not blank.ops.mocap_assist.accept_fix.poll()


def test_card_shows_four_figures_and_steps_on_request(sample, fix, blank, draw):
    raw = sample.animation_data.action
    action, card = fix()

    shown = draw("MOCAP_PT_fix")
    assert {"Before", "After", "Jitter", "Longest Slide", "Spikes, Gaps", "Issues"} <= set(
        shown
    )
    assert shown.count("mocap_assist_fix_details") == 1
    assert card["steps"][0] not in " ".join(shown)
    blank.context.window_manager.mocap_assist_fix_details = True
    try:
        assert card["steps"][0] in " ".join(draw("MOCAP_PT_fix"))
    finally:
        blank.context.window_manager.mocap_assist_fix_details = False
    assert "mocap_assist.revert_to_raw" in draw("MOCAP_PT_fix")

    blank.data.actions.remove(raw)

    reason = f"The raw action of {action.name} is not in this file."
    assert reason in " ".join(draw("MOCAP_PT_fix"))


def test_fixed_motion_is_retargeted_on_request(sample, fix, blank):
    raw = sample.animation_data.action
    assert blank.ops.mocap_assist.load_sample() == {"FINISHED"}
    rig = blank.context.object
    blank.context.view_layer.objects.active = sample

    action, card = fix(rig=rig.name, plant_feet=False)

    assert rig.animation_data.action.name == f"{action.name}.{rig.name}"
    assert "retargeted" in card["steps"][-1] and sample.animation_data.action == action
    with pytest.raises(RuntimeError, match="no armature Hero"):
        fix(rig="Hero")
    assert raw.users


def test_damaged_card_is_not_shown(sample, fix, draw):
    action, _ = fix()

    for text in ("{", "[]", '{"before": 1, "after": {}, "steps": []}'):
        action[CARD] = text
        assert "mocap_assist.accept_fix" not in draw("MOCAP_PT_fix")


def test_contacts_that_the_animator_keyed_are_used(sample, fix, load):
    contacts = load("mocap_assist.actions.contact_keys")
    first, _ = fix()
    frames = np.arange(1.0, 241.0)
    keyed = contacts.read_contacts(first, first.slots[0], frames)
    keyed[:, 0] = False
    contacts.write_contacts(sample, first, first.slots[0], frames, keyed)

    second, _ = fix()

    found = contacts.read_contacts(second, second.slots[0], frames)
    assert np.array_equal(found, keyed) and keyed[:, 1].any()


def test_second_press_starts_from_the_recording(sample, fix):
    raw = sample.animation_data.action
    first, card = fix()

    second, again = fix()

    assert again["before"] == card["before"]
    assert second["mocap_assist_source"] == first["mocap_assist_source"] == raw


def test_feet_stay_on_request(sample, fix):
    _, card = fix(plant_feet=False)

    assert not any("Plant Feet" in step for step in card["steps"])
    assert card["after"]["longest_foot_slide_cm"] > 5.0


def test_camera_take_is_reconstructed(blank, load, fix, tmp_path):
    truth = true_positions(
        load("solvers.samples"), load("solvers.motion.humanoid.posture_joints")
    )
    recording = tracked_walk(load("solvers.motion"), truth)
    load("solvers.recordings").write_joint_csv(recording, tmp_path / "kinect.csv")
    blank.context.scene.render.fps = 30
    path = str(tmp_path / "kinect.csv")
    assert blank.ops.mocap_assist.import_recording(filepath=path) == {"FINISHED"}
    raw = blank.context.object.animation_data.action

    action, card = fix()

    assert card["origin"] == "joints of a depth camera"
    assert action.name.endswith(".reconstructed")
    assert card["after"]["jitter_deg"] < 0.5 * card["before"]["jitter_deg"]
    assert blank.ops.mocap_assist.revert_to_raw() == {"FINISHED"}
    assert blank.context.object.animation_data.action == raw


def test_markers_become_a_skeleton(blank, load, fix, tmp_path, recordings, draw):
    take = load("solvers.recordings").read_recording(recordings / "mocap" / "05_13.c3d")
    positions = take.positions[:1200:4, :41].copy()
    positions[100:130, 5] = np.nan
    tracks = load("solvers.motion").Tracks(take.names[:41], positions, take.frame_rate / 4)
    load("solvers.recordings").write_c3d(tracks, tmp_path / "dance.c3d")
    path = str(tmp_path / "dance.c3d")
    assert blank.ops.mocap_assist.import_recording(filepath=path) == {"FINISHED"}

    action, card = fix()

    armature = blank.context.object
    assert armature.type == "ARMATURE" and "leftLowerLeg" in armature.pose.bones
    keys = load("mocap_assist.actions.contact_keys").contact_keys(action, action.slots[0])
    assert all(map(len, keys[:2]))  # so that Check and Plant Feet have the same contacts
    assert card["origin"] == "optical markers"
    assert any("Filled 30 samples" in step for step in card["steps"])
    shown = " ".join(draw("MOCAP_PT_fix"))
    assert "mocap_assist.revert_to_raw" not in shown and "undo" in shown


def test_points_of_no_marker_set_are_cleaned(blank, load, fix, tmp_path, rng):
    time = np.arange(90)[:, None, None] / 30.0
    path = np.sin(time + np.arange(4)[None, :, None]) * np.array([0.3, 0.2, 0.1])
    noisy = path + rng.normal(scale=0.005, size=path.shape)
    tracks = load("solvers.motion").Tracks(("a", "b", "c", "d"), noisy, 30.0)
    load("solvers.recordings").write_trc(tracks, tmp_path / "points.trc")
    file = str(tmp_path / "points.trc")
    assert blank.ops.mocap_assist.import_recording(filepath=file) == {"FINISHED"}

    action, card = fix()

    assert card["origin"] == "points without a known marker set"
    assert action.name.endswith(".clean")


def test_gray_button_says_what_to_select(blank, draw):
    assert not blank.ops.mocap_assist.fix_take.poll()
    blank.context.window_manager.mocap_assist_all_panels = True
    try:
        assert "Select an animated armature or marker set." in " ".join(draw("MOCAP_PT_fix"))
    finally:
        blank.context.window_manager.mocap_assist_all_panels = False


def test_command_fixes_and_saves(sample, blank, command, tmp_path):
    target = tmp_path / "fixed.blend"

    status, out, err = command("fix", "--output", str(target), "--json")

    assert (status, err) == (0, "")
    result = json.loads(out.splitlines()[0])
    assert (result["armature"], result["action"]) == ("Sample Walk", "Sample Walk.clean")
    assert result["before"]["issues"] > 10 > result["after"]["issues"]
    blank.ops.wm.open_mainfile(filepath=str(target))
    assert CARD in blank.data.objects["Sample Walk"].animation_data.action


def test_card_does_not_follow_to_the_result_of_another_button(sample, fix, blank):
    action, _ = fix()

    assert blank.ops.mocap_assist.plant_feet() == {"FINISHED"}

    assert "mocap_assist_fix" in action
    assert sample.animation_data.action != action
    assert "mocap_assist_fix" not in sample.animation_data.action


def test_history_says_whether_feet_were_planted(sample, fix):
    action, _ = fix(plant_feet=False)

    assert not json.loads(action["mocap_assist_history"])[-1]["settings"]["plant_feet"]
