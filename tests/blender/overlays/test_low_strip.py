"""In a low editor, such as the Timeline of a new file, related rows of the strip share one."""

from types import SimpleNamespace

import numpy as np
import pytest


@pytest.fixture
def ranges(load):
    return load("mocap_assist.overlays.marked_ranges")


@pytest.fixture
def drawing(load):
    found = load("mocap_assist.overlays.strip.drawing")
    found.forget()
    return found


def test_related_rows_share_one(load, ranges, drawing):
    row, mark = ranges.StripRow, ranges.Mark
    rows = {
        row.CONFIDENCE: (ranges.Range(1.0, 9.0, mark.LOW),),
        row.SPIKES: (ranges.Range(2.0, 2.0, mark.ISSUE),),
        row.GAPS: (ranges.Range(3.0, 4.0, mark.ISSUE),),
        row.FILLED: (ranges.Range(3.0, 4.0, mark.FILLED),),
        row.LEFT_FOOT: (ranges.Range(1.0, 5.0, mark.LEFT),),
        row.RIGHT_FOOT: (ranges.Range(4.0, 9.0, mark.RIGHT),),
    }

    found = ranges.join_related_rows(rows)

    assert list(found) == [row.CONFIDENCE, row.ISSUES, row.FILLED, row.CONTACTS]
    assert found[row.ISSUES] == rows[row.SPIKES] + rows[row.GAPS]
    strip = load("mocap_assist.overlays.strip.reading").Strip(1.0, 9.0, 1.0, found)
    corners, _ = drawing.rectangles_of(strip, width=1.0)
    left, right = corners[-2:, [0, 2], 1]
    assert 0.5 < left[0] < left[1] < 1.0
    assert 0.0 < right[0] < right[1] < 0.5


def test_a_low_editor_has_the_most_important_rows(ranges):
    row = ranges.StripRow
    found = (ranges.Range(1.0, 9.0, ranges.Mark.LOW),)
    rows = dict.fromkeys((row.CONFIDENCE, row.JITTER, row.FILLED, row.CONTACTS), found)

    assert list(ranges.most_important(rows, 1)) == [row.JITTER]
    assert list(ranges.most_important(rows, 2)) == [row.CONFIDENCE, row.JITTER]
    assert list(ranges.most_important(rows, 9)) == list(rows)


@pytest.fixture
def stepping(load, actor):
    """Keys of the confidence of a bone, and of both feet."""
    source = actor.animation_data.action, actor.animation_data.action_slot
    frames = np.arange(1.0, 61.0)
    load("mocap_assist.actions.contact_keys").write_contacts(
        actor, *source, frames, np.ones((60, 2), bool)
    )
    load("mocap_assist.actions.reliability_curves").write_reliability(
        actor, *source, frames, {"Head": np.ones(60)}
    )
    return actor


def test_markers_have_no_switch_as_they_have_no_strip(blank, draw):
    blank.ops.object.empty_add()
    holder = blank.context.object
    blank.ops.object.empty_add()
    blank.context.object.parent = holder
    blank.context.object.keyframe_insert("location")

    shown = draw("MOCAP_PT_check")

    assert "mocap_assist.measure_quality" in shown
    assert "mocap_assist_strip" not in shown


@pytest.mark.parametrize(
    ("space", "n_rows", "height"),
    [(24, 1, 6), (44, 2, 10), (39, 3, 5), (90, 2, 13)],
)
def test_rows_are_as_high_as_the_space_between_keys_and_numbers(drawing, space, n_rows, height):
    assert drawing.row_height(2.0 * space, n_rows, 2.0) == 2.0 * height


@pytest.mark.parametrize(("height", "n_rows"), [(300, 3), (70, 3), (60, 2)])
def test_rows_are_fewer_where_labels_have_no_space(blank, drawing, stepping, height, n_rows):
    editor = SimpleNamespace(
        scene=blank.context.scene,
        view_layer=blank.context.view_layer,
        preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)),
        region=SimpleNamespace(height=height),
        space_data=SimpleNamespace(show_markers=True),
    )

    found = drawing.fitting_strip(editor)

    assert len(found.rows) == n_rows
    assert drawing.fitting_strip(editor) is found
