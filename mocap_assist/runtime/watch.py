"""The one solve that runs beside Blender's work: shown while it runs, ended with its file."""

from collections.abc import Callable

import bpy

from ..drawing.view_drawing import redraw
from .ends_with_file import ends_with_file

BETWEEN_LOOKS = 0.05  # seconds
BUSY = "Another solve is running. Wait until it is done, or press Esc in its window."

_on: list["Watch"] = []


class Watch:
    """What the status bar and the sidebar say about a solve until it ends.

    Parameters
    ----------
    context : bpy.types.Context
        With a window, whose status bar says how far the work is.
    owner : str
        Names the panel that says so, too.
    stop : callable
        Ends the work, whatever it has found, before another file is loaded.
    """

    def __init__(
        self, context: bpy.types.Context, owner: str, stop: Callable[[], None]
    ) -> None:
        self._stop = stop
        manager = context.window_manager
        manager.mocap_assist_job.owner = owner
        self._timer = manager.event_timer_add(BETWEEN_LOOKS, window=context.window)
        _on.append(self)

    @property
    def is_on(self) -> bool:
        """Whether it is still shown; not after another file was loaded."""
        return self in _on

    def show(self, context: bpy.types.Context, fraction: float, message: str) -> None:
        """Say how far the work is."""
        state = context.window_manager.mocap_assist_job
        state.running, state.fraction, state.message = True, fraction, message
        context.workspace.status_text_set(f"{message} {fraction:.0%}   Esc: cancel")
        redraw(context)

    def end(self, context: bpy.types.Context) -> None:
        """Show nothing more."""
        _on.remove(self)
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.mocap_assist_job.running = False
        context.workspace.status_text_set(None)
        redraw(context)

    def abandon(self, context: bpy.types.Context) -> None:
        """End the work too, whatever it has found."""
        try:
            self._stop()
        finally:
            self.end(context)


def why_busy() -> str:
    """Return why no other solve can start, or nothing."""
    return BUSY if _on else ""


register, unregister = ends_with_file(_on, "mocap_assist_job")
