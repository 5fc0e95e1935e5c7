"""What follows the result of a button, in Blender with a window."""

from collections.abc import Callable

import bpy

listeners: list[Callable[[bpy.types.Scene], None]] = []
"""Called with the scene after each button that solves, except those without an undo step."""


def notify_listeners(scene: bpy.types.Scene) -> None:
    """Call all listeners."""
    for listener in listeners:
        listener(scene)
