"""Display of the running solve; it ends with its file."""

from collections.abc import Callable

import bpy

from ..drawing.view_drawing import redraw
from .file_change_handlers import ends_with_file

TIMER_INTERVAL_S = 0.05
BUSY = "Another solve is running. Wait until it is done, or press Esc in its window."

_on: list["Watch"] = []


class Watch:
    """Progress of a solve in the status bar and the sidebar.

    Parameters
    ----------
    context : bpy.types.Context
        With a window; its status bar shows the progress.
    owner : str
        Name of the panel that shows the progress too.
    stop : callable
        Discards the work before another file is loaded.
    """

    def __init__(
        self, context: bpy.types.Context, owner: str, stop: Callable[[], None]
    ) -> None:
        self._stop = stop
        manager = context.window_manager
        manager.mocap_assist_job.owner = owner
        self._timer = manager.event_timer_add(TIMER_INTERVAL_S, window=context.window)
        _on.append(self)

    @property
    def is_on(self) -> bool:
        """Whether the solve is still shown; False after another file was loaded."""
        return self in _on

    def show(self, context: bpy.types.Context, fraction: float, message: str) -> None:
        """Show the progress."""
        state = context.window_manager.mocap_assist_job
        state.running, state.fraction, state.message = True, fraction, message
        context.workspace.status_text_set(f"{message} {fraction:.0%}   Esc: cancel")
        redraw(context)

    def end(self, context: bpy.types.Context) -> None:
        """Remove the display."""
        _on.remove(self)
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.mocap_assist_job.running = False
        context.workspace.status_text_set(None)
        redraw(context)

    def abandon(self, context: bpy.types.Context) -> None:
        """Discard the work and remove the display."""
        try:
            self._stop()
        finally:
            self.end(context)


def why_busy() -> str:
    """Return why no other solve can start, or an empty text."""
    return BUSY if _on else ""


register, unregister = ends_with_file(_on, "mocap_assist_job")
