"""Calls after edits of a property, by the animator or by a script."""

from collections.abc import Callable
from typing import Any

import bpy
from bpy.app import handlers


def subscription(
    key: tuple[type[Any], str], notify: Callable[[], None]
) -> tuple[Callable[[], None], Callable[[], None]]:
    """Return functions that begin and end calls of `notify` after edits of a property.

    Parameters
    ----------
    key : a type of Blender, and the name of its property
    notify : callable
        Called once Blender is idle, in windows only.
    """
    owner = object()

    @handlers.persistent
    def subscribe(*_: object) -> None:
        """Blender forgets it whenever it loads a file."""
        bpy.msgbus.clear_by_owner(owner)
        bpy.msgbus.subscribe_rna(key=key, owner=owner, args=(), notify=notify)

    def begin() -> None:
        subscribe()
        handlers.load_post.append(subscribe)

    def end() -> None:
        handlers.load_post.remove(subscribe)
        bpy.msgbus.clear_by_owner(owner)

    return begin, end
