"""Draw the matches as a grid over a 3D View; the one under the pointer plays."""

from collections.abc import Iterator
from time import monotonic
from typing import Any, NamedTuple

import blf
import bpy
import gpu
import numpy as np

from ...solvers.arrays import Array
from ..languages import translated
from .gallery import GAP_PX, LABEL_PX, Box, cell_at, cells_in, figure_lines, posture_row
from .ghost_drawing import COLOR
from .match_grid import GOOD_SCORE
from .searches import Search

HINT = "Point at a clip to play it, click to select it, Esc to close. Left limbs are lighter."
TEXT_PX, LINE_PX, HEAD_PX = 12, 2.5, 30
"""Size of texts, width of bones and height of the hint, in pixels at scale 1."""
VEIL, CELL = (0.05, 0.05, 0.05, 0.82), (0.16, 0.16, 0.16, 1.0)
POINTED = (0.26, 0.30, 0.36, 1.0)
TEXT_COLOR, WEAK_COLOR = (0.95, 0.95, 0.95, 1.0), (0.6, 0.6, 0.6, 1.0)
"""Of good matches, and of others."""
LEFT_WHITE = 0.55
"""Fraction of white in the color of left limbs."""


class Gallery:
    """What is shown where, and which match plays."""

    def __init__(self, search: Search, area: bpy.types.Area) -> None:
        self.search = search
        self._area = area.as_pointer()
        self._pointed = -1
        self._since = monotonic()
        self._handle: Any = bpy.types.SpaceView3D.draw_handler_add(
            self._drawn, (), "WINDOW", "POST_PIXEL"
        )

    def close(self) -> None:
        """Remove the drawing; a second call has no effect."""
        if self._handle is not None:
            bpy.types.SpaceView3D.draw_handler_remove(self._handle, "WINDOW")
            self._handle = None

    def point_at(self, area: bpy.types.Area, x: int, y: int, scale: float) -> int:
        """Let the match at a point of the window play; return its number, -1 for none."""
        region = window_region(area)
        found = cell_at(self._cells(area, scale), x - region.x, y - region.y)
        if found != self._pointed:
            self._pointed, self._since = found, monotonic()
        return found

    def _cells(self, area: bpy.types.Area, scale: float) -> list[Box]:
        space = free_space(area)
        below = space._replace(height=max(space.height - HEAD_PX * scale, 1.0))
        return cells_in(below, len(self.search.finding.found), scale)

    def _drawn(self) -> None:
        context = bpy.context
        if context.area.as_pointer() != self._area:
            return
        scale = context.preferences.system.ui_scale
        space, cells = free_space(context.area), self._cells(context.area, scale)
        gpu.state.blend_set("ALPHA")
        _draw_boxes([(space, VEIL), *self._backgrounds(cells)])
        _draw_bones(list(self._figures(cells)), scale)
        gpu.state.blend_set("NONE")
        hint = translated(HINT)
        margin = GAP_PX * scale
        line = space.y + space.height - 0.5 * HEAD_PX * scale - 0.4 * TEXT_PX * scale
        _write(hint, space.x + margin, line, space.width, TEXT_COLOR, scale)
        for index, cell in enumerate(cells):
            self._label(index, cell, scale)

    def _backgrounds(self, cells: list[Box]) -> Iterator[tuple[Box, tuple[float, ...]]]:
        for index, cell in enumerate(cells):
            yield cell, POINTED if index == self._pointed else CELL

    def _figures(self, cells: list[Box]) -> Iterator[tuple[Array, Array]]:
        for index, cell in enumerate(cells):
            found = self.search.finding.found[index]
            seconds = monotonic() - self._since if index == self._pointed else None
            lines, left = figure_lines(found, posture_row(found, seconds), cell)
            white = LEFT_WHITE * left[:, None]
            colors = np.tile(np.array(COLOR), (len(lines), 1))
            colors[:, :3] += white * (1.0 - colors[:, :3])
            yield lines, colors

    def _label(self, index: int, cell: Box, scale: float) -> None:
        match = self.search.finding.found[index].match
        color = TEXT_COLOR if match.score >= GOOD_SCORE else WEAK_COLOR
        margin, width = 0.5 * GAP_PX * scale, cell.width - GAP_PX * scale
        upper = cell.y + 0.58 * LABEL_PX * scale
        _write(f"{match.score:.0%}", cell.x + margin, upper, width, color, scale)
        lower = cell.y + 0.18 * LABEL_PX * scale
        _write(match.clip, cell.x + margin, lower, width, color, scale)


class _Corner(NamedTuple):
    left: float
    bottom: float
    right: float
    top: float


def window_region(area: bpy.types.Area) -> bpy.types.Region:
    """Return the region of an area that shows the view."""
    return next(region for region in area.regions if region.type == "WINDOW")


def free_space(area: bpy.types.Area) -> Box:
    """Return the part of the view that no toolbar, sidebar or header covers."""
    window = window_region(area)
    free = _Corner(window.x, window.y, window.x + window.width, window.y + window.height)
    for region in area.regions:
        if region.width <= 1 or region.height <= 1:
            continue
        if region.type == "UI" and region.x > window.x:
            free = free._replace(right=min(free.right, region.x))
        elif region.type == "TOOLS":
            free = free._replace(left=max(free.left, region.x + region.width))
        elif region.type in {"HEADER", "TOOL_HEADER"} and region.y > window.y:
            free = free._replace(top=min(free.top, region.y))
    width, height = free.right - free.left, free.top - free.bottom
    return Box(free.left - window.x, free.bottom - window.y, max(width, 1), max(height, 1))


def _draw_boxes(boxes: list[tuple[Box, tuple[float, ...]]]) -> None:
    from gpu_extras.batch import batch_for_shader

    corners, colors = [], []
    for box, color in boxes:
        left, low, right, high = box.x, box.y, box.x + box.width, box.y + box.height
        ends = [(left, low), (right, low), (left, high), (right, high)]
        corners += [ends[corner] for corner in (0, 1, 2, 2, 1, 3)]
        colors += [color] * 6
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    batch_for_shader(shader, "TRIS", {"pos": corners, "color": colors}).draw(shader)


def _draw_bones(figures: list[tuple[Array, Array]], scale: float) -> None:
    from gpu_extras.batch import batch_for_shader

    lines = np.concatenate([np.zeros((0, 2, 2)), *(each for each, _ in figures)])
    points = np.zeros((2 * len(lines), 3), np.float32)
    points[:, :2] = lines.reshape(-1, 2)
    colors = np.concatenate([np.zeros((0, 4)), *(each for _, each in figures)])
    painted = colors.repeat(2, axis=0).astype(np.float32)
    shader = gpu.shader.from_builtin("POLYLINE_SMOOTH_COLOR")
    batch = batch_for_shader(shader, "LINES", {"pos": points, "color": painted})
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", LINE_PX * scale)
    batch.draw(shader)


def _write(
    text: str, x: float, y: float, width: float, color: tuple[float, ...], scale: float
) -> None:
    """Write a text; one that is too long loses its middle, as in Blender's lists."""
    font = 0
    blf.size(font, TEXT_PX * scale)
    blf.color(font, *color)
    shown, kept = text, len(text)
    while kept > 1 and blf.dimensions(font, shown)[0] > width:
        kept -= 1
        shown = f"{text[: kept // 2]}…{text[len(text) - (kept - kept // 2) :]}"
    blf.position(font, x, y, 0.0)
    blf.draw(font, shown)
