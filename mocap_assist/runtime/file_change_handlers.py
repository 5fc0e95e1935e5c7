"""End work that runs in the background before the file that it belongs to is replaced."""

from collections.abc import Callable, Sequence
from typing import Any

import bpy
from bpy.app import handlers


def ends_with_file(running: Sequence[Any], state: str) -> tuple[Callable[[], None], ...]:
    """Return `register` and `unregister` of a module whose work ends with its file.

    Parameters
    ----------
    running : sequence
        The work in progress; `abandon(context)` ends each and takes it out.
    state : str
        Property of the window manager whose `running` is shown. A file that was saved meanwhile
        says that the work still runs.
    """

    @handlers.persistent
    def abandon_all(*_: object) -> None:
        while running:
            running[-1].abandon(bpy.context)

    @handlers.persistent
    def reset_running(*_: object) -> None:
        for manager in bpy.data.window_managers:
            getattr(manager, state).running = False

    def register() -> None:
        handlers.load_pre.append(abandon_all)
        handlers.load_post.append(reset_running)

    def unregister() -> None:
        abandon_all()
        handlers.load_post.remove(reset_running)
        handlers.load_pre.remove(abandon_all)

    return register, unregister
