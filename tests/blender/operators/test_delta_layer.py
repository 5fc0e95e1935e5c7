"""Delta Layer: the change of Clean on an additive NLA track above the recorded action."""

import itertools

import numpy as np
import pytest
from numpy.testing import assert_allclose

ROUNDING = 1e-4
"""Blender's NLA takes the angle of a delta from a 32-bit arc cosine, which is flat near 1."""
FRAMES = (1, 17, 40, 60)
BONES = ("Hips", "Head", "LeftArm", "RightLeg")
PROPERTIES = {
    "QUATERNION": "rotation_quaternion",
    "XYZ": "rotation_euler",
    "AXIS_ANGLE": "rotation_axis_angle",
}


@pytest.fixture(params=PROPERTIES)
def shaken(request, make_armature, animate, blank, rng):
    """A figure in a rotation mode, its channels with noise; quaternions are of any length."""
    armature = make_armature(mode=request.param)
    animate(armature)
    bag = armature.animation_data.action.layers[0].strips[0].channelbags[0]
    for curve in bag.fcurves:
        for key in curve.keyframe_points:
            key.co.y = 1.3 * (key.co.y + rng.normal(scale=0.02))
        curve.update()
    return armature


@pytest.fixture
def matrices(blank):
    """Return the matrices of some bones at some frames."""

    def found(armature):
        result = []
        for frame in FRAMES:
            blank.context.scene.frame_set(frame)
            result += [np.array(armature.pose.bones[name].matrix) for name in BONES]
        return np.array(result)

    return found


def test_delta_at_full_influence_gives_the_clean_pose_and_at_zero_the_raw_one(
    shaken, clean, matrices, blank, keys_of
):
    raw_action, raw = shaken.animation_data.action, matrices(shaken)
    keys = keys_of(raw_action)
    blank.context.scene.frame_start, blank.context.scene.frame_end = 10, 45
    clean(frame_range="SCENE")
    cleaned = matrices(shaken)
    blank.ops.mocap_assist.revert_to_raw()

    clean(frame_range="SCENE", result_as="DELTA_LAYER")

    base, delta = shaken.animation_data.nla_tracks
    strip = delta.strips[0]
    assert shaken.animation_data.action is None and strip.blend_type == "COMBINE"
    assert base.strips[0].action == raw_action and keys_of(raw_action) == keys
    assert_allclose(matrices(shaken), cleaned, atol=ROUNDING)
    assert np.abs(cleaned - raw).max() > 0.01
    strip.influence = 0.0
    assert_allclose(matrices(shaken), raw, atol=ROUNDING)
    strip.influence = 0.5
    assert 1e-3 < np.abs(matrices(shaken) - raw).max() < np.abs(cleaned - raw).max()


def test_delta_is_a_result_that_is_replaced_and_reverted(noisy, clean, blank, draw):
    raw = noisy.animation_data.action
    own = noisy.animation_data.nla_tracks.new()

    clean(result_as="DELTA_LAYER")
    clean(result_as="DELTA_LAYER", strength=0.5)

    names = [track.name for track in noisy.animation_data.nla_tracks]
    assert names == [own.name, "walk", "walk.delta.001"]
    assert {"walk.clean.001", "Made from walk", "influence"} <= set(draw("MOCAP_PT_compare"))
    assert blank.ops.mocap_assist.revert_to_raw() == {"FINISHED"}
    assert noisy.animation_data.action == raw
    assert noisy.animation_data.nla_tracks.values() == [own]


def test_second_clean_keeps_the_keys_of_the_influence(noisy, clean):
    clean(result_as="DELTA_LAYER")
    strip = noisy.animation_data.nla_tracks[1].strips[0]
    for frame, value in ((5, 0.25), (20, 0.75)):
        strip.influence = value
        strip.keyframe_insert("influence", frame=frame)

    result = clean(result_as="DELTA_LAYER", strength=0.5)

    delta = noisy.animation_data.nla_tracks[1]
    strip = delta.strips[0]
    keys = [tuple(key.co) for curve in strip.fcurves for key in curve.keyframe_points]
    assert keys == [(5.0, 0.25), (20.0, 0.75)]
    assert result is None and strip.action.name == strip.name == delta.name == "walk.delta.001"


def test_second_clean_keeps_the_strips_where_they_were_moved(noisy, clean, load):
    clean(result_as="DELTA_LAYER")
    strips = [track.strips[0] for track in noisy.animation_data.nla_tracks]
    for strip in strips:
        strip.scale = 2.0
        strip.frame_start += 30.0
    before = [(each.frame_start, each.frame_end) for each in strips]

    clean(result_as="DELTA_LAYER", strength=0.5)

    strips = [track.strips[0] for track in noisy.animation_data.nla_tracks]
    assert [(each.frame_start, each.frame_end) for each in strips] == before == [before[0]] * 2
    assert [each.scale for each in strips] == [2.0, 2.0]
    assert [each.action.name for each in strips] == ["walk", "walk.delta.001"]

    channels = load("mocap_assist.blender.compat").channelbag(
        strips[0].action, strips[0].action_slot
    )
    for curve in channels.fcurves:
        curve.keyframe_points.insert(61, curve.evaluate(60))
    clean(result_as="DELTA_LAYER")

    strips = [track.strips[0] for track in noisy.animation_data.nla_tracks]
    assert [(each.frame_start, each.frame_end) for each in strips] == [(1.0, 61.0)] * 2
    assert strips[1].action.name == "walk.delta.002"


def test_delta_without_its_base_is_replaced_with_its_influence(noisy, clean):
    """A delta that the animator laid on a track stays."""
    clean(result_as="DELTA_LAYER")
    tracks, raw = noisy.animation_data.nla_tracks, noisy.animation_data.nla_tracks[0]
    action, slot = raw.strips[0].action, raw.strips[0].action_slot
    tracks[1].strips[0].influence = 0.25
    tracks.remove(raw)
    lone = tracks.new()
    lone.strips.new("lone", 1, tracks[0].strips[0].action)
    noisy.animation_data.action = action
    noisy.animation_data.action_slot = slot
    tracks[0].strips[0].influence = lone.strips[0].influence = 0.25

    clean(result_as="DELTA_LAYER", strength=0.5)

    played = [(t.strips[0].action.name, t.strips[0].influence) for t in tracks]
    assert played == [("walk.delta", 0.25), ("walk", 1.0), ("walk.delta.001", 0.25)]


def delete_last_bone(blank, armature):
    blank.ops.object.mode_set(mode="EDIT")
    armature.data.edit_bones.remove(armature.data.edit_bones[-1])
    blank.ops.object.mode_set(mode="OBJECT")


def play_another_action(blank, armature):
    armature.animation_data.action = None


@pytest.mark.parametrize("change", [delete_last_bone, play_another_action])
def test_take_that_changes_between_time_slices_gets_no_delta(
    noisy, blank, load, monkeypatch, change
):
    source = noisy.animation_data.action, noisy.animation_data.action_slot
    time_slices = load("mocap_assist.blender.time_slices")
    clock = itertools.count()
    monkeypatch.setattr(time_slices, "monotonic", lambda: next(clock))
    write = load("mocap_assist.actions.delta_layer").write_delta
    work = time_slices.Work(write, noisy, source, source)
    assert not work.run_slice(3)

    change(blank, noisy)

    with pytest.raises(ValueError, match="was changed during the solve; nothing was written"):
        while not work.run_slice(3):
            pass
    assert list(blank.data.actions) == [source[0]]


def test_dialed_influence_shows_at_once(noisy, clean, load, blank):
    clean(result_as="DELTA_LAYER")
    strip = noisy.animation_data.nla_tracks[1].strips[0]
    head = noisy.pose.bones["Head"]
    blank.context.scene.frame_set(17)
    before = np.array(head.matrix)

    strip.influence = 0.0
    load("mocap_assist.check.delta_influence").show_influence()  # as the window does
    blank.context.view_layer.update()

    at_once = np.array(head.matrix)
    blank.context.scene.frame_set(17)
    assert_allclose(at_once, np.array(head.matrix), atol=0)
    assert np.abs(at_once - before).max() > 0.01


def test_delta_of_a_second_base_has_its_own_influence(noisy, clean, blank):
    clean(result_as="DELTA_LAYER")
    first = noisy.animation_data.nla_tracks[1].strips[0]
    first.influence = 0.25
    second_take = noisy.animation_data.nla_tracks[0].strips[0].action.copy()
    second_take.name = "run"
    noisy.animation_data.action = second_take
    noisy.animation_data.action_slot = second_take.slots[0]

    clean(result_as="DELTA_LAYER")

    strips = [track.strips[0] for track in noisy.animation_data.nla_tracks]
    played = [(strip.action.name, strip.influence) for strip in strips]
    assert played == [("walk", 1.0), ("walk.delta", 0.25), ("run", 1.0), ("run.delta", 1.0)]
    assert blank.ops.mocap_assist.revert_to_raw() == {"FINISHED"}
    assert noisy.animation_data.action == second_take
    assert [track.name for track in noisy.animation_data.nla_tracks] == ["walk", "walk.delta"]


def test_new_action_takes_the_place_of_a_delta(noisy, clean):
    clean(result_as="DELTA_LAYER")

    action = clean()

    assert noisy.animation_data.action == action and action.name == "walk.clean.001"
    assert not noisy.animation_data.nla_tracks


def test_delta_of_markers_is_refused(blank):
    blank.ops.object.empty_add()
    holder = blank.context.object
    for number in range(3):
        blank.ops.object.empty_add()
        blank.context.object.parent = holder
        for frame in range(1, 40):
            blank.context.object.location = number, frame, 0.0
            blank.context.object.keyframe_insert("location", frame=frame)

    with pytest.raises(RuntimeError, match="Delta Layer is for armatures"):
        blank.ops.mocap_assist.denoise(result_as="DELTA_LAYER")


def test_delta_is_hidden_only_by_an_action_of_most_bones(noisy, clean, blank, load):
    played_result = load("mocap_assist.scene.history").played_result
    clean(result_as="DELTA_LAYER")

    noisy.pose.bones["Head"].keyframe_insert("rotation_euler", frame=20)
    by_hand = noisy.animation_data.action
    assert played_result(noisy)[0].name == "walk.clean"

    for bone in noisy.pose.bones:
        bone.keyframe_insert("rotation_euler", frame=20)
    assert played_result(noisy) is None
    bag = load("mocap_assist.blender.compat").channelbag(by_hand, by_hand.slots[0])
    for curve in [each for each in bag.fcurves if '"Head"' not in each.data_path]:
        bag.fcurves.remove(curve)

    assert blank.ops.mocap_assist.revert_to_raw() == {"FINISHED"}
    assert by_hand.use_fake_user


@pytest.mark.parametrize("output", ["ACTION", "NLA_TRACK", "DELTA_LAYER"])
def test_fix_by_hand_above_a_result_is_saved_when_clean_replaces_it(
    noisy, clean, blank, output
):
    raw = noisy.animation_data.action
    clean(result_as="NLA_TRACK")
    by_hand = blank.data.actions.new("by hand")
    slot = by_hand.slots.new("OBJECT", noisy.name)
    noisy.animation_data.action, noisy.animation_data.action_slot = by_hand, slot

    clean(result_as=output)

    assert noisy.animation_data.action != by_hand
    assert by_hand.use_fake_user and not raw.use_fake_user
