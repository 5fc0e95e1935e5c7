"""Reports have the frames of the timeline, also where an action starts elsewhere than at 1."""

import json

import pytest


@pytest.fixture
def after_a_pose(blank, make_armature, animate):
    """A figure that dances for four seconds from frame 101 on, its first frame a T-pose."""
    armature = make_armature(mode="XYZ")
    action = animate(armature, range(101, 221))
    for curve in action.layers[0].strips[0].channelbag(action.slots[0]).fcurves:
        if "rotation" in curve.data_path:
            curve.keyframe_points[0].co.y += 1.5
            curve.update()
    blank.context.scene.render.fps = 30
    return armature


def test_clean_and_its_history_name_them(blank, after_a_pose):
    blank.ops.mocap_assist.denoise(plant_feet=False)

    action = after_a_pose.animation_data.action
    (entry,) = json.loads(action["mocap_assist_history"])
    assert "Frame 101 is a separate pose and was kept as recorded." in entry["prior_used"]


def test_fix_names_them_on_its_card(blank, after_a_pose):
    blank.ops.mocap_assist.fix_take()

    action = after_a_pose.animation_data.action
    card = json.loads(action["mocap_assist_fix"])
    assert "Frame 101 is a separate pose and was kept as recorded." in card["steps"]
    assert "cut before frame 102\n" in blank.context.scene.mocap_assist.report


def test_a_result_on_a_moved_and_scaled_strip_is_reported_where_it_plays(blank, after_a_pose):
    blank.ops.mocap_assist.denoise(plant_feet=False, result_as="NLA_TRACK")
    (strip,) = after_a_pose.animation_data.nla_tracks[-1].strips
    strip.frame_start, strip.scale = 11.0, 2.0

    blank.ops.mocap_assist.measure_quality()

    assert "cut before frame 13\n" in blank.context.scene.mocap_assist.report
    cut = next(each for each in blank.context.scene.mocap_assist.issues if each.kind == "cut")
    assert (cut.start, cut.stop) == (101.0, 102.0)  # of the action


def test_a_result_on_two_strips_is_reported_where_each_plays(blank, after_a_pose):
    """All frames were those of the first strip, also frames that only the second plays."""
    blank.ops.mocap_assist.denoise(plant_feet=False, result_as="NLA_TRACK")
    track = after_a_pose.animation_data.nla_tracks[-1]
    (strip,) = track.strips
    strip.action_frame_start = 150.0
    second = track.strips.new("start", 301, strip.action)
    second.action_slot = strip.action_slot
    second.action_frame_end = 149.0

    blank.ops.mocap_assist.measure_quality()

    assert "cut before frame 302\n" in blank.context.scene.mocap_assist.report
