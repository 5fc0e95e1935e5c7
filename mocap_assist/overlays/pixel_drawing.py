"""Boxes, lines and texts over a 3D View, in pixels from the corner of its region."""

from typing import NamedTuple

import blf
import bpy
import gpu
import numpy as np

from ...solvers.arrays import Array
from .view_drawing import Color

TEXT_PX = 12
"""Size of a text, in pixels at scale 1."""
TEXT_COLOR: Color = (0.95, 0.95, 0.95, 1.0)
WEAK_COLOR: Color = (0.6, 0.6, 0.6, 1.0)
"""Of a text that matters less."""


class Box(NamedTuple):
    """A rectangle."""

    x: float
    y: float
    width: float
    height: float

    def has(self, x: float, y: float) -> bool:
        """Whether a point is within it."""
        return self.x <= x < self.x + self.width and self.y <= y < self.y + self.height


class _Edges(NamedTuple):
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
    free = _Edges(window.x, window.y, window.x + window.width, window.y + window.height)
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


def draw_boxes(boxes: list[tuple[Box, Color]]) -> None:
    """Fill rectangles, the first one below the others."""
    from gpu_extras.batch import batch_for_shader

    corners, colors = [], []
    for box, color in boxes:
        left, low, right, high = box.x, box.y, box.x + box.width, box.y + box.height
        ends = [(left, low), (right, low), (left, high), (right, high)]
        corners += [ends[corner] for corner in (0, 1, 2, 2, 1, 3)]
        colors += [color] * 6
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    gpu.state.blend_set("ALPHA")
    batch_for_shader(shader, "TRIS", {"pos": corners, "color": colors}).draw(shader)
    gpu.state.blend_set("NONE")


def draw_colored_lines(lines: Array, colors: Array, width: float) -> None:
    """Draw lines of shape (n_lines, 2, 2), each in its own color: shape (n_lines, 4)."""
    from gpu_extras.batch import batch_for_shader

    points = np.zeros((2 * len(lines), 3), np.float32)
    points[:, :2] = lines.reshape(-1, 2)
    content = {"pos": points, "color": colors.repeat(2, axis=0).astype(np.float32)}
    shader = gpu.shader.from_builtin("POLYLINE_SMOOTH_COLOR")
    batch = batch_for_shader(shader, "LINES", content)
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", width)
    gpu.state.blend_set("ALPHA")
    batch.draw(shader)
    gpu.state.blend_set("NONE")


def write(text: str, corner: tuple[float, float], width: float, color: Color) -> None:
    """Write a text; one that is wider loses its middle, as in Blender's lists."""
    font, shown, kept = 0, text, len(text)
    blf.size(font, TEXT_PX * bpy.context.preferences.system.ui_scale)
    blf.color(font, *color)
    while kept > 1 and blf.dimensions(font, shown)[0] > width:
        kept -= 1
        shown = f"{text[: kept // 2]}…{text[len(text) - (kept - kept // 2) :]}"
    blf.position(font, *corner, 0.0)
    blf.draw(font, shown)
