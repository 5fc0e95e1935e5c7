"""Draw the strip at the bottom of the Timeline, the Dope Sheet and the Graph Editor."""

from collections.abc import Iterator
from typing import Any

import bpy
import gpu
import numpy as np

from ....solvers.arrays import Single
from ...languages import translated
from ..marked_ranges import COLORS, LANES, Range, StripRow, join_related_rows, most_important
from . import labels, reading
from .reading import Strip

EDITORS = ("DOPESHEET_EDITOR", "GRAPH_EDITOR")
MODES = {"TIMELINE", "DOPESHEET", "ACTION", "SHAPEKEY", "FCURVES"}
"""Of these editors, the modes whose keys are those of objects."""
ROW_HEIGHT_PX, GAP_PX = 13, 3
"""Height of a row, and distance from the border, in pixels at scale 1."""
MIN_LABELED_PX, MIN_ROW_PX = 10, 5
"""Height below which a row has no label, and its minimum, in pixels at scale 1."""
MIN_STRIP_PX = 6
"""Minimum of the height of all rows, in pixels at scale 1: what a Timeline of default height
has between its keys and its frame numbers."""
SCROLLER_PX, MARKERS_PX, RULER_PX = 10, 42, 24
"""Height of Blender's scroll bar, of its row of markers, and of its ruler at the top, in pixels
at scale 1."""
MIN_WIDTH_PX = 2.0
"""Minimum width of a range, where many ranges lie in one pixel."""
ROW_INSET = 0.08
"""Distance between two rows, as a fraction of their height."""
BACKGROUND = (0.06, 0.06, 0.06, 0.7)

_low_strips: dict[tuple[int, int], tuple[Strip, Strip]] = {}
"""For each strip and number of rows, the one whose related rows are joined, for editors of low
height."""
_batches: dict[tuple[int, float], tuple[Strip, Any]] = {}
"""Of ranges, in frames and rows."""


def forget() -> None:
    """Clear the caches, so that the next drawing reads again."""
    reading.forget()
    labels.forget()
    _batches.clear()
    _low_strips.clear()


def fitting_strip(context: bpy.types.Context) -> Strip | None:
    """Return the strip of an editor; related rows share one where labels have no space.

    Of these, a low editor has the most important ones.
    """
    strip = reading.strip_of(context)
    if strip is None:
        return None
    _, height = strip_height(context, len(strip.rows))
    scale = context.preferences.system.ui_scale
    if height >= MIN_LABELED_PX * scale:
        return strip
    space = context.region.height - strip_bottom(context, len(strip.rows), scale)
    key = id(strip), max(int((space / scale - RULER_PX) / MIN_ROW_PX), 1)
    known = _low_strips.get(key)
    if known is None or known[0] is not strip:
        _make_room(_low_strips)
        rows = most_important(join_related_rows(strip.rows), key[1])
        known = _low_strips[key] = strip, strip._replace(rows=rows)
    return known[1]


def _make_room(store: dict[Any, Any]) -> None:
    """Drop the oldest entry of a full cache."""
    if len(store) >= reading.MAX_CACHED:
        del store[next(iter(store))]


def draw_strip(context: bpy.types.Context) -> None:
    """Draw the rows of the active armature where the editor shows their frames."""
    if context.space_data.mode not in MODES:
        return
    strip = fitting_strip(context)
    if strip is None:
        return
    scale = context.preferences.system.ui_scale
    bottom, height = strip_height(context, len(strip.rows))
    first, last = visible_frames(context.region)
    pixels_per_frame = context.region.width / (last - first)
    batch = _batch_of(strip, min_width(pixels_per_frame, strip.step))
    _draw_batch(batch, (-first * pixels_per_frame, bottom), (pixels_per_frame, height))
    if height >= MIN_LABELED_PX * scale:
        texts = tuple(translated(row.value) for row in strip.rows)
        labels.draw_labels(labels.Labels(texts, height, scale), bottom)


def min_width(pixels_per_frame: float, step: float) -> float:
    """Return the minimum width of a drawn range, in frames: that of some pixels, or a sample.

    It is a power of two, so that the batches are made again only when the zoom has doubled.
    """
    return max(step, float(2.0 ** np.ceil(np.log2(MIN_WIDTH_PX / pixels_per_frame))))


def visible_frames(region: bpy.types.Region) -> tuple[float, float]:
    """Return the frames at the left and at the right border of a region."""
    left, _ = region.view2d.region_to_view(0, 0)
    right, _ = region.view2d.region_to_view(region.width, 0)
    return left, right


def strip_height(context: bpy.types.Context, n_rows: int) -> tuple[float, float]:
    """Return the height of the strip in its region, and that of one of its rows."""
    scale = context.preferences.system.ui_scale
    bottom = strip_bottom(context, n_rows, scale)
    return bottom, row_height(context.region.height - bottom, n_rows, scale)


def strip_bottom(context: bpy.types.Context, n_rows: int, scale: float) -> float:
    """Return the height of the strip in its region.

    It lies above the scroll bar and the markers; in a low editor it covers the markers.
    """
    has_markers = context.space_data.show_markers and len(context.scene.timeline_markers)
    needed = RULER_PX + MARKERS_PX + n_rows * ROW_HEIGHT_PX
    is_high = context.region.height >= needed * scale
    return (GAP_PX + (MARKERS_PX if has_markers and is_high else SCROLLER_PX)) * scale


def row_height(space: float, n_rows: int, scale: float) -> float:
    """Return the height of a row: less than usual where a low editor has no more space."""
    free = (space - RULER_PX * scale) / n_rows
    return max(min(ROW_HEIGHT_PX * scale, free), MIN_STRIP_PX * scale / n_rows)


def _draw_batch(batch: Any, corner: tuple[float, float], unit: tuple[float, float]) -> None:
    """Draw a batch from a corner, with units of these numbers of pixels."""
    gpu.state.blend_set("ALPHA")
    with gpu.matrix.push_pop():
        gpu.matrix.translate(corner)
        gpu.matrix.scale(unit)
        batch.draw(gpu.shader.from_builtin("SMOOTH_COLOR"))
    gpu.state.blend_set("NONE")


def _batch_of(strip: Strip, width: float) -> Any:
    """Return the batch of a strip; it is made once for each doubled zoom."""
    key = id(strip), width
    known = _batches.get(key)
    if known is None or known[0] is not strip:
        _make_room(_batches)
        known = _batches[key] = strip, _make_batch(strip, width)
    return known[1]


def _make_batch(strip: Strip, width: float) -> Any:
    from gpu_extras.batch import batch_for_shader

    corners, colors = rectangles_of(strip, width)
    first = np.arange(len(corners), dtype=np.int32)[:, None, None] * 4
    triangles = (first + np.array([[0, 1, 2], [2, 1, 3]], np.int32)).reshape(-1, 3)
    content = {"pos": corners.reshape(-1, 2), "color": colors.reshape(-1, 4)}
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    return batch_for_shader(shader, "TRIS", content, indices=triangles)


def rectangles_of(strip: Strip, width: float) -> tuple[Single, Single]:
    """Return corners, shape (n, 4, 2), and their colors, shape (n, 4, 4).

    Columns are frames; the first and the last of a range are covered completely. Rows are
    counted from the bottom. Rectangles of the background, one for each row, come first. A range
    is at least `width` frames wide.
    """
    found = [(strip.first, strip.last, row, row + 1.0, BACKGROUND) for row in _heights(strip)]
    found += [
        (each.first, each.last, row + low, row + high, COLORS[each.mark])
        for row, each, (low, high) in _ranges(strip)
    ]
    first, last, bottom, top = np.array([each[:4] for each in found], np.float32).T
    middle = 0.5 * (first + last)
    half = 0.5 * np.maximum(last - first + strip.step, width)
    left, right = middle - half, middle + half
    low, high = bottom + ROW_INSET, top - ROW_INSET
    corners = np.stack([left, low, right, low, left, high, right, high], axis=1)
    colors = np.array([each[4] for each in found], np.float32)
    painted = np.repeat(colors[:, None], 4, axis=1)
    return np.ascontiguousarray(corners.reshape(-1, 4, 2), np.float32), painted


def _heights(strip: Strip) -> Iterator[float]:
    yield from range(len(strip.rows) - 1, -1, -1)


def _ranges(strip: Strip) -> Iterator[tuple[float, Range, tuple[float, float]]]:
    """Yield the height of each range's row, the range, and its lower and upper end in there."""
    for height, row in zip(_heights(strip), strip.rows, strict=True):
        for each in strip.rows[row]:
            is_shared = row is StripRow.CONTACTS
            yield height, each, LANES.get(each.mark, (0.0, 1.0)) if is_shared else (0.0, 1.0)
