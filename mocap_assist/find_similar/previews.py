"""Thumbnails of matches as icons, stored while their search is listed."""

from typing import Any

import bpy.utils.previews
import numpy as np
from numpy.typing import NDArray

from .searches import Search

FIGURE_COLOR = (0.15, 0.45, 0.85)
"""Red, green and blue, each a fraction. Chosen by hand for a contrast of 2.2 or more both to
the gray 0.24 of the dark theme's panels and to the 0.7 of the light theme's."""

_icons: list[Any] = []
_shown: list[int] = []


def icon_of(search: Search, index: int) -> int:
    """Return the number of the icon of a match; 0 where none can be made."""
    if not _icons:
        return 0
    icons = _icons[0]
    if _shown != [search.number]:
        icons.clear()
        _shown[:] = [search.number]
    name = str(index)
    if name not in icons:
        pixels = search.finding.found[index].picture
        height, width, _ = pixels.shape
        icon = icons.new(name)
        icon.image_size = (width, height)
        icon.image_pixels_float.foreach_set(as_blender_wants(pixels).ravel())
    return int(icons[name].icon_id)


def as_blender_wants(pixels: NDArray[np.uint8]) -> NDArray[np.float32]:
    """Return red, green, blue and alpha from 0 to 1, the lowest row first.

    The figures have one color, on a transparent card: a lighter limb is more transparent, and
    so fainter on any background. Colors are multiplied by alpha, as Blender draws previews.
    """
    opacity = 1.0 - pixels[::-1, :, :1].astype(np.float32) / np.float32(255.0)
    return opacity * np.array([*FIGURE_COLOR, 1.0], dtype=np.float32)


def give_picture(action: bpy.types.Action, pixels: NDArray[np.uint8]) -> None:
    """Let pixels, shape (height, width, 3), be the preview of an action."""
    preview = action.preview_ensure()
    preview.image_size = pixels.shape[1::-1]
    preview.image_pixels_float.foreach_set(as_blender_wants(pixels).ravel())


def register() -> None:
    """Make room for icons."""
    _icons.append(bpy.utils.previews.new())


def unregister() -> None:
    """Forget them."""
    bpy.utils.previews.remove(_icons.pop())
    _shown.clear()
