"""What is drawn and listed is in time with a result on a moved or scaled NLA strip."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

STRIPS = {
    "moved": {"start": 101},
    "slower": {"start": 31, "scale": 2.0},
    "reversed": {"start": 101, "use_reverse": True},
    "repeated": {"start": 11, "scale": 0.5, "repeat": 2.5},
    "cut": {"start": 51, "action_frame_start": 20.0, "action_frame_end": 40.0},
}


@pytest.fixture
def result(load, actor):
    """The actor, who plays a result that was made from its action, with one foot in contact."""
    history = load("mocap_assist.scene.history")
    raw = actor.animation_data.action
    made = raw.copy()
    history.record(made, (raw, raw.slots[0]), {"operation": "clean", "slot": "OBactor"})
    contacts = np.zeros((60, 7), bool)
    contacts[9:20, 0] = True
    load("mocap_assist.actions.contact_keys").write_contacts(
        actor, made, made.slots[0], np.arange(1.0, 61.0), contacts
    )
    load("mocap_assist.blender.compat").assign(actor, made, made.slots[0])
    load("mocap_assist.overlays.comparison.drawing").forget()
    return actor


def lay_strip(armature, start=1, **timing):
    """Play the action of an armature on an NLA strip."""
    animation = armature.animation_data
    action = animation.action
    strip = animation.nla_tracks.new().strips.new(action.name, start, action)
    strip.action_slot = action.slots[0]
    animation.action = None
    for name, value in timing.items():
        setattr(strip, name, value)
    return strip


@pytest.mark.parametrize("timing", STRIPS.values(), ids=STRIPS)
def test_frames_of_the_action_are_those_that_blender_plays(blank, load, result, timing):
    (curve, *_) = [
        each
        for each in load("mocap_assist.blender.compat")
        .channelbag(result.animation_data.action, result.animation_data.action_slot)
        .fcurves
        if each.data_path.endswith(".location")
    ]
    bone = result.pose.bones[curve.data_path.split('"')[1]]
    strip = lay_strip(result, **timing)
    time = load("mocap_assist.scene.played_time").played_time(result)
    begin, end = int(strip.frame_start), int(strip.frame_end)

    for frame in (begin - 5, begin, begin + 3, (begin + end) // 2, end - 1, end, end + 9):
        blank.context.scene.frame_set(frame)
        shown = curve.evaluate(time.action_frame(frame))
        assert_allclose(bone.location[curve.array_index], shown, atol=1e-5, err_msg=str(frame))


@pytest.mark.parametrize("timing", [STRIPS["moved"], STRIPS["slower"]], ids=["moved", "slower"])
def test_contacts_and_the_strip_follow(blank, load, result, timing):
    strip = lay_strip(result, **timing)
    begin, scale = strip.frame_start, strip.scale
    first, last = begin + 9 * scale, begin + 19 * scale

    (shown,) = load("mocap_assist.overlays.strip.reading").strip_of(blank.context).rows.values()
    assert shown[0][:2] == (first, last)
    rings_at = load("mocap_assist.overlays.contacts.rings").rings_at
    there = [rings_at(result, frame) is not None for frame in (15.0, first, last, last + scale)]
    assert there == [False, True, True, False]


def test_strip_is_read_again_where_it_was_moved(blank, load, result):
    strip_of = load("mocap_assist.overlays.strip.reading").strip_of
    strip = lay_strip(result)
    assert strip_of(blank.context).first == 1
    strip.frame_start_ui = 31

    assert strip_of(blank.context).first == 31


def test_issues_are_shown_where_the_strip_plays_them(blank, draw, result):
    lay_strip(result, start=101)
    scene = blank.context.scene
    issue = scene.mocap_assist.issues.add()
    issue.name, issue.start, issue.stop, issue.kind = "LeftArm", 20.0, 22.0, "gap"
    scene.mocap_assist.checked_action = blank.data.actions["walk"]

    blank.ops.mocap_assist.jump_to_issue(index=0)
    assert scene.frame_current == 120
    blank.ops.mocap_assist.mark_issues()
    assert [each.frame for each in scene.timeline_markers] == [120]


@pytest.mark.usefixtures("actor")
def test_clean_changes_the_frames_of_the_preview_range_as_played(blank, load, result):
    """Frame 111 to 120 of the scene are frame 11 to 20 of the action."""
    lay_strip(result, start=101)
    read_take = load("mocap_assist.actions.armature_read").read_take
    frames = load("mocap_assist.actions.frames")
    scene = blank.context.scene
    scene.use_preview_range, scene.frame_preview_start, scene.frame_preview_end = True, 111, 120
    played = load("mocap_assist.runtime.selection").played_source(result)

    take = read_take(result, scene, frames.FrameRange.PREVIEW, played)

    assert_allclose(take.frames, np.arange(11.0, 21.0))


def test_each_strip_of_a_cut_result_has_its_own_time(blank, load, result):
    """The animator cuts a result at frame 30, and moves the second half to frame 131."""
    first = lay_strip(result, action_frame_end=30.0)
    (track,) = result.animation_data.nla_tracks
    second = track.strips.new("second half", 131, first.action)
    second.action_slot, second.action_frame_start = first.action_slot, 31.0
    second.frame_start_ui = 131.0
    played_time = load("mocap_assist.scene.played_time").played_time
    scene = blank.context.scene

    assert [played_time(result, frame).action_frame(frame) for frame in (5, 50, 131, 140)] == [
        5.0, 30.0, 31.0, 40.0,
    ]  # fmt: skip
    issue = scene.mocap_assist.issues.add()
    issue.start, issue.stop = 40.0, 42.0
    shown_frames = load("mocap_assist.runtime.selection").shown_frames
    assert shown_frames(blank.context, issue) == (140.0, 142.0)
    scene.use_preview_range, scene.frame_preview_start, scene.frame_preview_end = True, 141, 150
    assert_allclose(preview_frames(load, result, scene), np.arange(41.0, 51.0))


def test_preview_range_of_a_raw_take_in_tweak_mode_is_that_of_its_strip(blank, load, actor):
    strip, animation = lay_strip(actor, start=101), actor.animation_data
    scene = blank.context.scene
    animation.nla_tracks.active = animation.nla_tracks[0]
    strip.select = True
    animation.use_tweak_mode = True
    scene.use_preview_range, scene.frame_preview_start, scene.frame_preview_end = True, 111, 120

    assert_allclose(preview_frames(load, actor, scene), np.arange(11.0, 21.0))


def preview_frames(load, armature, scene):
    """Return the frames of the action that are read of the preview range."""
    read_take = load("mocap_assist.actions.armature_read").read_take
    preview = load("mocap_assist.actions.frames").FrameRange.PREVIEW
    played = load("mocap_assist.runtime.selection").played_source(armature)
    return read_take(armature, scene, preview, played).frames


def test_overlay_draws_the_pose_that_blender_shows(blank, load, result, monkeypatch):
    lay_strip(result, start=101)
    drawing = load("mocap_assist.overlays.comparison.drawing")
    drawn = []
    monkeypatch.setattr(drawing, "draw_lines", lambda lines, *_: drawn.append(lines))
    look = drawing.Look(((0, 0, 0, 1),) * 2, 1.0, True, None, None)
    blank.context.scene.frame_set(117)

    drawing._draw_figures(result, 117.0, look)

    bone = result.pose.bones[0]
    assert_allclose(drawn[1][0], [bone.head, bone.tail], atol=1e-5)


def test_held_key_shows_the_recorded_action_in_the_time_of_the_strip(blank, load, result):
    raw_view, scene = load("mocap_assist.check.raw_view"), blank.context.scene
    scene.frame_set(17)
    bone = result.pose.bones[0]
    recorded = bone.location.copy()
    (curve, *_) = (
        load("mocap_assist.blender.compat")
        .channelbag(result.animation_data.action, result.animation_data.action_slot)
        .fcurves
    )
    for each in curve.id_data.layers[0].strips[0].channelbags[0].fcurves:
        if each.data_path == f'pose.bones["{bone.name}"].location':
            for key in each.keyframe_points:
                key.co.y += 1.0
    lay_strip(result, start=101)
    scene.frame_set(117)
    played = bone.location.copy()

    raw_view.show_raw(blank.context)
    scene.frame_set(118)
    scene.frame_set(117)
    assert_allclose(bone.location, recorded, atol=1e-5)
    raw_view.restore_played()
    scene.frame_set(117)

    assert_allclose(bone.location, played, atol=1e-5)
    assert len(result.animation_data.nla_tracks) == 1


def test_held_key_shows_the_recorded_action_on_each_strip_of_a_cut_result(blank, load, result):
    raw_view, scene = load("mocap_assist.check.raw_view"), blank.context.scene
    bone = result.pose.bones[0]
    recorded = {}
    for frame in (17, 40):
        scene.frame_set(frame)
        recorded[frame] = bone.location.copy()
    first = lay_strip(result, action_frame_end=30.0)
    (track,) = result.animation_data.nla_tracks
    second = track.strips.new("second half", 131, first.action)
    second.action_slot, second.action_frame_start = first.action_slot, 31.0
    second.frame_start_ui = 131.0

    raw_view.show_raw(blank.context)

    shown = {}
    for frame, scene_frame in ((17, 17), (40, 140)):
        scene.frame_set(scene_frame)
        shown[frame] = bone.location.copy()
    raw_view.restore_played()
    assert recorded[17] != recorded[40]
    assert_allclose(shown[17], recorded[17], atol=1e-5)
    assert_allclose(shown[40], recorded[40], atol=1e-5)
    assert len(result.animation_data.nla_tracks) == 1


def test_held_key_removes_its_own_track_alone(blank, load, result):
    """The recorded action may lie on a track of its name, as below a delta."""
    raw_view = load("mocap_assist.check.raw_view")
    (raw, _), animation = (
        load("mocap_assist.scene.history").raw_of(result.animation_data.action),
        result.animation_data,
    )
    below = animation.nla_tracks.new()
    below.name = raw.name
    below.strips.new(raw.name, 101, raw)
    strip = lay_strip(result, start=101)
    before = [(track.name, len(track.strips)) for track in animation.nla_tracks]

    raw_view.show_raw(blank.context)
    assert len(animation.nla_tracks) == 3
    raw_view.restore_played()

    assert [(track.name, len(track.strips)) for track in animation.nla_tracks] == before
    assert animation.nla_tracks[-1].strips[0] == strip
