"""Number the frames of a stream by their time."""

from collections.abc import Callable
from time import monotonic

MAX_GAP_S = 0.5
"""Seconds without data after which the actor is measured from the start, or the filters begin
again. It guards filters, whose frames follow each other, and lengths from a few frames."""
MAX_AHEAD_S = 5.0
"""Seconds by which a step of the clock may exceed the time that passed here. It guards against
clocks that jump and those of other senders, and allows for frames that waited."""


def is_continued(elapsed_s: float) -> bool:
    """Return whether a frame follows soon after the last one."""
    return 0.0 < elapsed_s <= MAX_GAP_S


class TimeSlots:
    """Gives frames the number of their slot at the rate of the stream, from 1.

    Slots without a frame are left out. A clock that was set back, or far ahead of the time that
    passed here, goes on from the last slot.

    Parameters
    ----------
    time : float, seconds
        Of the frame with number 0.
    frame_rate : float, hertz
    now : callable
        Returns seconds.
    """

    def __init__(
        self, time: float, frame_rate: float, *, now: Callable[[], float] = monotonic
    ) -> None:
        self._start = self._last = time
        self._slot = self._first_slot = 0
        self._rate = frame_rate
        self._now = now
        self._taken_at = now()

    def next(self, time: float) -> int | None:
        """Return the slot of a frame; None if the last one has it already."""
        taken_at = self._now()
        step, passed = time - self._last, taken_at - self._taken_at
        self._taken_at = taken_at
        if not 0.0 < step <= passed + MAX_AHEAD_S:
            self._start, self._first_slot = time, self._slot + 1
        slot = self._first_slot + round((time - self._start) * self._rate)
        self._last = time
        if slot <= self._slot:
            return None
        self._slot = slot
        return slot
