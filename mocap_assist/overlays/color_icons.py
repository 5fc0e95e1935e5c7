"""Icons that show a color of a drawing, for the legends in panels."""

from collections.abc import Callable, Iterable
from typing import Any

import bpy.utils.previews
import numpy as np

from ...solvers.arrays import Single
from .marked_ranges import COLORS, Mark
from .view_drawing import Color

ICON_PX = 16
"""Size of an icon, in pixels at scale 1: Blender's own."""
UNLIT: Color = (0.5, 0.5, 0.5, 0.35)
BARS = {Mark.LOW: 1, Mark.MEDIUM: 2, Mark.HIGH: 3}
"""Number of lit bars, so that levels of confidence are distinct without colors, too."""

_icons: list[Any] = []


def draw_marks(layout: bpy.types.UILayout, marks: Iterable[Mark], *, columns: int) -> None:
    """Draw a legend: the color of each mark, and what it means."""
    grid = layout.grid_flow(row_major=True, columns=columns, even_columns=True, align=True)
    for mark in marks:
        grid.label(text=mark.value, icon_value=square_icon(COLORS[mark]))


def square_icon(color: Color) -> int:
    """Return the number of an icon: a square in a color."""
    return _icon(f"square {color}", lambda: _square(color))


def bars_icon(mark: Mark) -> int:
    """Return the number of an icon: one to three bars in the color of a confidence."""
    return _icon(f"bars {mark.name}", lambda: _bars(COLORS[mark], BARS[mark]))


def _icon(name: str, painted: Callable[[], Single]) -> int:
    icons = _icons[0]
    if name not in icons:
        icon = icons.new(name)
        icon.icon_size = (ICON_PX, ICON_PX)
        icon.icon_pixels_float.foreach_set(painted().ravel())
    return int(icons[name].icon_id)


def _square(color: Color) -> Single:
    pixels = np.zeros((ICON_PX, ICON_PX, 4), np.float32)
    pixels[2:-2, 2:-2] = (*color[:3], 1.0)
    return pixels


def _bars(color: Color, n_lit: int) -> Single:
    """Return three bars, each higher than the one to its left; the lowest row comes first."""
    pixels = np.zeros((ICON_PX, ICON_PX, 4), np.float32)
    for bar in range(3):
        left = 2 + 4 * bar
        shade = (*color[:3], 1.0) if bar < n_lit else UNLIT
        pixels[2 : 6 + 4 * bar, left : left + 3] = shade
    return pixels


def register() -> None:
    """Make space for the icons."""
    _icons.append(bpy.utils.previews.new())


def unregister() -> None:
    """Remove them."""
    bpy.utils.previews.remove(_icons.pop())
