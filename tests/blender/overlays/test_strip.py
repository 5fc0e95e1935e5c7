"""The strip below the keys shows the ranges that an action really has."""

import numpy as np
import pytest


@pytest.fixture
def ranges(load):
    return load("mocap_assist.overlays.marked_ranges")


@pytest.fixture
def reading(load):
    found = load("mocap_assist.overlays.strip.reading")
    found.forget()
    return found


def curves_of(action):
    return action.layers[0].strips[0].channelbag(action.slots[0]).fcurves


def played(armature):
    return armature.animation_data.action, armature.animation_data.action_slot


def remove_keys(action, bone, frames):
    for curve in curves_of(action):
        if f'"{bone}"' in curve.data_path:
            for key in reversed(curve.keyframe_points):
                if round(key.co.x) in frames:
                    curve.keyframe_points.remove(key)
            curve.update()


def shown(strip):
    return {
        row.name: [(round(each.first, 2), round(each.last, 2)) for each in found]
        for row, found in strip.rows.items()
    }


def test_frames_at_successive_steps_are_one_range(ranges):
    frames = np.array([7.0, 1.0, 2.0, 2.0, 3.0, 9.0])

    found = ranges.ranges_of(frames, 1.0, ranges.Mark.FILLED)

    assert [each[:2] for each in found] == [(1, 3), (7, 7), (9, 9)]
    assert ranges.ranges_of(np.empty(0), 1.0, ranges.Mark.FILLED) == ()


def test_frames_of_a_take_at_another_rate_are_one_range(ranges):
    frames = 1.0 + 0.24 * np.arange(5)

    (found,) = ranges.ranges_of(frames, 0.24, ranges.Mark.FILLED)

    assert (found.first, found.last) == (1.0, pytest.approx(1.96))


def test_confidence_has_a_range_for_each_level(ranges):
    lowest = np.array([0.9, 0.9, 0.49, 0.2, 0.5, 0.74, 0.75, np.nan, 1.0])

    found = ranges.confidence_ranges(lowest, np.arange(9.0), 1.0)

    assert [(each.mark.name, *each[:2]) for each in found] == [
        ("HIGH", 0, 1), ("LOW", 2, 3), ("MEDIUM", 4, 5), ("HIGH", 6, 6), ("HIGH", 8, 8),
    ]  # fmt: skip


def test_foot_is_down_until_the_frame_before_it_lifts(ranges):
    keys = np.array([[1, 1], [10, 0], [20, 1], [25, 1], [30, 0], [40, 1], [50, 1]])

    for end, stop in ((50.0, 50), (60.0, 60), (45.0, 50)):
        found = ranges.contact_ranges(keys, end, 1.0, ranges.Mark.LEFT)

        assert [each[:2] for each in found] == [(1, 9), (20, 29), (40, stop)]


def test_gap_is_filled_and_spike_is_corrected(blank, reading, actor):
    """A gap of the recording, and keys of the result that Clean marked as generated."""
    remove_keys(actor.animation_data.action, "LeftArm", range(20, 30))
    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}
    for curve in curves_of(actor.animation_data.action):
        if '"Head"' in curve.data_path:
            for frame in (40, 41):
                curve.keyframe_points[frame - 1].type = "GENERATED"

    strip = shown(reading.strip_of(blank.context))

    assert strip["FILLED"] == [(20, 29)]
    assert (40, 41) in strip["CORRECTED"]


@pytest.fixture
def stepping(load, actor):
    """Feet are down from frame 10 to 20 and from frame 31 on, hand and hips in the first 10."""
    contacts = np.zeros((60, 7), bool)
    contacts[9:20, 0] = contacts[30:, 1] = True
    contacts[:10, [3, 6]] = True
    load("mocap_assist.actions.contact_keys").write_contacts(
        actor, *played(actor), np.arange(1.0, 61.0), contacts
    )
    return actor


def test_contacts_are_those_of_the_keys(blank, reading, stepping):
    assert shown(reading.strip_of(blank.context)) == {
        "LEFT_FOOT": [(10, 20)],
        "RIGHT_FOOT": [(31, 60)],
        "RIGHT_HAND": [(1, 10)],
        "HIPS": [(1, 10)],
    }


def test_confidence_is_the_lowest_of_all_or_of_the_selected_bones(
    blank, reading, load, compat, actor
):
    frames, sure = np.arange(1.0, 61.0), np.ones(60)
    arm, leg = np.where(frames < 21, 0.1, 1.0), np.where(frames > 50, 0.6, 1.0)
    load("mocap_assist.actions.reliability_curves").write_reliability(
        actor, *played(actor), frames, {"LeftArm": arm, "LeftLeg": leg, "Head": sure}
    )
    assert shown(reading.strip_of(blank.context))["CONFIDENCE"] == [(1, 20), (21, 50), (51, 60)]

    blank.ops.object.mode_set(mode="POSE")
    for bone in actor.pose.bones:
        compat.select_bone(bone, bone.name == "Head")

    (found,) = reading.strip_of(blank.context).rows.values()
    assert [(each.first, each.last, each.mark.name) for each in found] == [(1, 60, "HIGH")]

    above = actor.pose.bones["LeftArm"].parent
    for bone in actor.pose.bones:
        compat.select_bone(bone, bone == above)
    assert shown(reading.strip_of(blank.context))["CONFIDENCE"][0] == (1, 20)


@pytest.fixture
def compat(load):
    return load("mocap_assist.blender.compat")


def test_issues_are_those_that_check_listed_for_this_action(blank, reading, actor, load):
    action = actor.animation_data.action
    for curve in curves_of(action):
        curve.keyframe_points[30].co.y += 1.0
    assert blank.ops.mocap_assist.measure_quality() == {"FINISHED"}
    issues = blank.context.scene.mocap_assist.issues
    spikes = [(each.start, each.stop) for each in issues if each.kind == "spike"]
    assert spikes

    strip = shown(reading.strip_of(blank.context))
    assert strip["SPIKES"] == spikes
    assert sum(map(len, strip.values())) == len(issues)
    issues[0].kind = "of a later version"
    load("mocap_assist.overlays.comparison.drawing").refresh()
    strip = shown(reading.strip_of(blank.context))
    assert sum(map(len, strip.values())) == len(issues) - 1

    blank.context.scene.mocap_assist.checked_action = blank.data.actions.new("another action")
    assert reading.strip_of(blank.context) is None


def test_nothing_is_shown_without_an_animated_armature(blank, reading, make_armature):
    assert reading.strip_of(blank.context) is None
    make_armature()
    assert reading.strip_of(blank.context) is None


def test_action_is_read_once_until_it_is_edited(blank, reading, load, stepping, monkeypatch):
    load("mocap_assist.overlays.comparison.drawing").refresh()
    read, read_action = [], reading.read_action
    monkeypatch.setattr(
        reading, "read_action", lambda *given: read.append(given) or read_action(*given)
    )

    first = reading.strip_of(blank.context)
    blank.context.scene.frame_set(30)
    assert reading.strip_of(blank.context) is first
    assert len(read) == 1

    load("mocap_assist.overlays.comparison.drawing").refresh()
    assert shown(reading.strip_of(blank.context)) == shown(first)
    assert len(read) == 2


def test_cache_has_no_blender_data(blank, reading, stepping):
    reading.strip_of(blank.context)

    ((key, _),) = reading._strips.items()

    assert all(isinstance(part, int | str | tuple) for part in key)
    blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    assert not reading._strips


def test_rectangles_cover_the_last_frame_of_a_range(load, ranges, reading):
    drawing = load("mocap_assist.overlays.strip.drawing")
    rows = {
        ranges.StripRow.SPIKES: (ranges.Range(5.0, 5.0, ranges.Mark.ISSUE),),
        ranges.StripRow.FILLED: (ranges.Range(8.0, 9.0, ranges.Mark.FILLED),),
    }

    strip = reading.Strip(1.0, 10.0, 1.0, rows)

    corners, colors = drawing.rectangles_of(strip, width=1.0)

    assert corners[:, [0, 1], 0].tolist() == [[0.5, 10.5], [0.5, 10.5], [4.5, 5.5], [7.5, 9.5]]
    assert corners[:, 0, 1].astype(int).tolist() == [1, 0, 1, 0]  # the first row is on top
    assert colors[3, 0] == pytest.approx(ranges.COLORS[ranges.Mark.FILLED])


def test_range_of_one_frame_is_visible_in_a_long_take(load, ranges, reading):
    drawing = load("mocap_assist.overlays.strip.drawing")
    rows = {ranges.StripRow.SPIKES: (ranges.Range(500.0, 500.0, ranges.Mark.ISSUE),)}
    strip = reading.Strip(1.0, 10_000.0, 1.0, rows)
    pixels_per_frame = 0.1

    width = drawing.min_width(pixels_per_frame, strip.step)
    corners, _ = drawing.rectangles_of(strip, width)

    left, right = corners[1, [0, 1], 0]
    assert (right - left) * pixels_per_frame >= drawing.MIN_WIDTH_PX
    assert 0.5 * (left + right) == 500.0
    assert drawing.min_width(20.0, strip.step) == 1.0


def test_panel_names_what_fills_the_strip(draw, actor):
    assert "Nothing to show yet" in " ".join(draw("MOCAP_PT_check"))


def test_panel_has_the_switch_and_names_the_colors(blank, draw, stepping):
    assert "mocap_assist_strip" in draw("MOCAP_PT_check")
    assert "Left Contact" in draw("MOCAP_PT_check")
    assert not {"Low", "Issues"} & set(draw("MOCAP_PT_check"))

    blank.context.window_manager.mocap_assist_strip = False
    try:
        assert "Left Contact" not in draw("MOCAP_PT_check")
    finally:
        blank.context.window_manager.mocap_assist_strip = True


def test_drawing_ends_with_the_extension(extension, load):
    switch = load("mocap_assist.overlays.strip.switch")
    assert len(switch._handles) == 2
    extension.unregister()
    assert not switch._handles
    extension.register()
    assert [space.__name__ for space, _ in switch._handles] == [
        "SpaceDopeSheetEditor",
        "SpaceGraphEditor",
    ]


def test_a_take_without_issues_was_checked(actor, blank, draw):
    """The panel asked for a Check below the result of one."""
    assert "Nothing to show yet" in " ".join(draw("MOCAP_PT_check"))

    blank.ops.mocap_assist.measure_quality()

    shown = " ".join(draw("MOCAP_PT_check"))
    assert "No issues found" in shown and "Nothing to show yet" not in shown
