"""Display of the running solve; it ends with its file."""

from collections.abc import Callable
from time import monotonic

import bpy

from ..blender.redrawing import redraw
from ..languages import translated
from .file_change_handlers import ends_with_file

TIMER_INTERVAL_S = 0.05
"""Seconds between two looks at a solve, and between two displays of its progress. It bounds the
delay of its result."""
CANCEL = "mocap_assist.cancel_solve"
CANCELS, CANCEL_TEXT = "Esc cancels", "Cancel"
MIN_FRACTION = 0.05
"""Fraction of a solve from which the time left is shown. It guards estimates from a few
frames."""
MIN_ELAPSED_S = 2.0
"""Seconds from which the time left is shown. It guards short solves: theirs cannot be read."""
SECONDS_UP_TO_S = 90.0
"""Seconds up to which the time left is in seconds, and in minutes from there. It guards against
figures more exact than the estimate."""
BUSY = "Another solve is running. Wait until it is done, or press Esc in its window."

_on: list["Watch"] = []
at_end: list[Callable[[], None]] = []
"""Called after each solve that was requested, whatever its outcome."""


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
    interval_s : float, seconds
        Between two looks at the solve. The progress is displayed less often.
    is_quiet : bool
        The animator did not request this solve: nothing displays it, no button waits for it,
        and the next solve ends it.
    """

    def __init__(
        self,
        context: bpy.types.Context,
        owner: str,
        stop: Callable[[], None],
        interval_s: float = TIMER_INTERVAL_S,
        *,
        is_quiet: bool = False,
    ) -> None:
        self.is_cancelled, self.is_quiet = False, is_quiet
        abandon_quiet(context)
        self._stop = stop
        self._began = monotonic()
        self._shown_at = float("-inf")
        self._display_s = TIMER_INTERVAL_S if interval_s < TIMER_INTERVAL_S else 0.0
        self.ending, self.button = CANCELS, CANCEL_TEXT
        manager = context.window_manager
        if not is_quiet:
            manager.mocap_assist_job.owner = owner
        self._timer = manager.event_timer_add(interval_s, window=context.window)
        _on.append(self)

    @property
    def is_on(self) -> bool:
        """Whether the solve is still shown; False after another file was loaded."""
        return self in _on

    def show(self, context: bpy.types.Context, fraction: float, message: str) -> None:
        """Show the progress, at limited intervals."""
        if self.is_quiet or monotonic() - self._shown_at < self._display_s:
            return
        self._shown_at = monotonic()
        state = context.window_manager.mocap_assist_job
        if not state.running or fraction < state.fraction:  # a new phase, or take
            self._began = monotonic()
        state.running, state.fraction, state.message = True, fraction, message
        state.ending = self.ending
        left = time_left(fraction, monotonic() - self._began)
        parts = [f"{translated(message)} {percentage(fraction)}".strip(), translated(left)]
        shown = "   ".join([*filter(None, parts), translated(self.ending)])

        def draw(header: bpy.types.Header, context: bpy.types.Context) -> None:
            row = header.layout.row(align=True)
            row.label(text=shown, translate=False)
            row.operator(CANCEL, text=translated(self.button), icon="X", translate=False)

        context.workspace.status_text_set(draw)
        redraw(context)

    def end(self, context: bpy.types.Context) -> None:
        """Remove the display."""
        _on.remove(self)
        context.window_manager.event_timer_remove(self._timer)
        if not self.is_quiet:
            context.window_manager.mocap_assist_job.running = False
            context.workspace.status_text_set(None)
            for listener in at_end:
                listener()
        redraw(context)

    def abandon(self, context: bpy.types.Context) -> None:
        """Discard the work and remove the display."""
        try:
            self._stop()
        finally:
            self.end(context)


def why_not_cancel(context: bpy.types.Context) -> str:
    """Return why there is nothing to cancel, or an empty text."""
    return "" if why_busy() else "No solve is running."


def cancel_running() -> None:
    """Let the running solve end as Esc does."""
    for watch in _on:
        watch.is_cancelled = True


def percentage(fraction: float) -> str:
    """Return how much is done, or an empty text for work that ends by Esc, or is done."""
    return f"{fraction:.0%}" if fraction < 1.0 else ""


def time_left(fraction: float, elapsed_s: float) -> str:
    """Return how long a solve will still take, or an empty text while that is not known."""
    if not MIN_FRACTION <= fraction < 1.0 or elapsed_s < MIN_ELAPSED_S:
        return ""
    left_s = elapsed_s * (1.0 - fraction) / fraction
    if left_s < SECONDS_UP_TO_S:
        return f"{max(round(left_s), 1)} s left"
    return f"{round(left_s / 60.0)} min left"


def why_busy() -> str:
    """Return why no other solve can start, or an empty text."""
    return BUSY if any(not each.is_quiet for each in _on) else ""


def abandon_quiet(context: bpy.types.Context) -> None:
    """End the solves that were not requested."""
    for quiet in [each for each in _on if each.is_quiet]:
        quiet.abandon(context)


def is_quiet_on() -> bool:
    """Whether a solve runs that was not requested."""
    return any(each.is_quiet for each in _on)


register, unregister = ends_with_file(_on, "mocap_assist_job")
