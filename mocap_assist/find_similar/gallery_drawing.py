"""Draw the matches as a grid over a 3D View; the one under the pointer plays."""

from collections.abc import Iterator
from time import monotonic
from typing import Any

import bpy
import numpy as np
from bpy.app import handlers

from ...solvers.arrays import Array
from ..blender.redrawing import redraw
from ..languages import translated
from ..overlays.pixel_drawing import (
    TEXT_COLOR,
    TEXT_PX,
    WEAK_COLOR,
    Box,
    draw_boxes,
    draw_colored_lines,
    free_space,
    window_region,
    write,
)
from ..overlays.view_drawing import Color
from .gallery import GAP_PX, LABEL_PX, cell_at, cells_in, figure_lines, posture_row
from .ghost_drawing import COLOR
from .match_grid import GOOD_SCORE
from .searches import Search

FRAME_S = 1 / 24
"""Seconds from one drawing to the next while the matches are shown."""
HINT = "Point at a clip to play it, click to select it, Esc to close. Left limbs are lighter."
LINE_PX, HEAD_PX = 2.5, 30
"""Width of bones and height of the hint, in pixels at scale 1."""
VEIL: Color = (0.05, 0.05, 0.05, 0.96)
CELL: Color = (0.16, 0.16, 0.16, 1.0)
POINTED: Color = (0.26, 0.30, 0.36, 1.0)
LEFT_WHITE = 0.55
"""Fraction of white in the color of left limbs."""
_open: list["Gallery"] = []


class Gallery:
    """What is shown where, and which match plays; also what Blender must forget at its end.

    Blender ends an operator without a call when its file or the extension goes.
    """

    def __init__(
        self, context: bpy.types.Context, search: Search, area: bpy.types.Area
    ) -> None:
        self.search = search
        self._area = area.as_pointer()
        self._pointed = -1
        self._since = monotonic()
        self._handle: Any = bpy.types.SpaceView3D.draw_handler_add(
            self._draw_gallery, (), "WINDOW", "POST_PIXEL"
        )
        self._timer = context.window_manager.event_timer_add(FRAME_S, window=context.window)
        _open.append(self)

    @property
    def is_open(self) -> bool:
        """Whether it is shown."""
        return self in _open

    def close(self, context: bpy.types.Context) -> None:
        """Remove the drawing and its timer; a second call has no effect."""
        if not self.is_open:
            return
        _open.remove(self)
        bpy.types.SpaceView3D.draw_handler_remove(self._handle, "WINDOW")
        context.window_manager.event_timer_remove(self._timer)
        redraw(context, "VIEW_3D")

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

    def _draw_gallery(self) -> None:
        context = bpy.context
        if context.area.as_pointer() != self._area:
            return
        scale = context.preferences.system.ui_scale
        space, cells = free_space(context.area), self._cells(context.area, scale)
        draw_boxes([(space, VEIL), *self._backgrounds(cells)])
        lines, colors = zip(*self._figures(cells), strict=True)
        draw_colored_lines(np.concatenate(lines), np.concatenate(colors), LINE_PX * scale)
        line = space.y + space.height - (0.5 * HEAD_PX + 0.4 * TEXT_PX) * scale
        corner = space.x + GAP_PX * scale, line
        write(translated(HINT), corner, space.width - 2 * GAP_PX * scale, TEXT_COLOR)
        for index, cell in enumerate(cells):
            self._label(index, cell, scale)

    def _backgrounds(self, cells: list[Box]) -> Iterator[tuple[Box, Color]]:
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
        left, width = cell.x + 0.5 * GAP_PX * scale, cell.width - GAP_PX * scale
        score = f"{match.score:.0%}" if self.search.is_ranked else ""
        for text, height in ((score, 0.58), (match.clip, 0.18)):
            write(text, (left, cell.y + height * LABEL_PX * scale), width, color)


@handlers.persistent
def _close_all(*_: object) -> None:
    while _open:
        _open[-1].close(bpy.context)


def register() -> None:
    """Let the matches disappear before another file is loaded."""
    handlers.load_pre.append(_close_all)


def unregister() -> None:
    """Remove what is shown."""
    handlers.load_pre.remove(_close_all)
    _close_all()
