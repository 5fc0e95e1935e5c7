"""Keep a solver ready while the sidebar tab is in use, so that a press answers at once."""

from time import monotonic

import bpy

from ..jobs.waiting_child import end_waiting, keep_waiting
from .preference_values import preference_value

CHECK_INTERVAL_S = 1.0
"""Seconds between two looks whether a solver is ready. It bounds how soon after a press the
next one answers at once."""
UNUSED_S = 600.0
"""Seconds without a drawing of the tab after which the solver is ended. It bounds the time for
which its memory, 0.13 GB, is kept for nothing."""

_drawn_at = [0.0]


def note_drawing() -> None:
    """Note that the tab is drawn; the first time this starts a solver soon after."""
    _drawn_at[0] = monotonic()
    if not bpy.app.background and not bpy.app.timers.is_registered(_check):
        bpy.app.timers.register(_check, first_interval=CHECK_INTERVAL_S, persistent=True)


def _check() -> float | None:
    if not preference_value("keep_solver_ready") or monotonic() - _drawn_at[0] > UNUSED_S:
        end_waiting()
        return None
    if not bpy.context.window_manager.mocap_assist_job.running:
        keep_waiting()
    return CHECK_INTERVAL_S


def unregister() -> None:
    """End the solver that waits."""
    if bpy.app.timers.is_registered(_check):
        bpy.app.timers.unregister(_check)
    end_waiting()
