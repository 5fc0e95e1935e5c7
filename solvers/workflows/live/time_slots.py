"""Number the frames of a stream by their time."""

MAX_GAP_S = 0.5
"""Seconds without data after which the actor is measured from the start, or the filters begin
again. It guards filters, whose frames follow each other, and lengths from a few frames."""


def is_continued(elapsed_s: float) -> bool:
    """Return whether a frame follows soon after the last one."""
    return 0.0 < elapsed_s <= MAX_GAP_S


class TimeSlots:
    """Gives frames the number of their slot at the rate of the stream, from 1.

    Slots without a frame are left out. A clock that was set back goes on from the last slot.

    Parameters
    ----------
    time : float, seconds
        Of the frame with number 0.
    frame_rate : float, hertz
    """

    def __init__(self, time: float, frame_rate: float) -> None:
        self._start = self._last = time
        self._slot = 0
        self._rate = frame_rate

    def next(self, time: float) -> int | None:
        """Return the slot of a frame; None if the last one has it already."""
        if time <= self._last:
            self._start = time - (self._slot + 1) / self._rate
        slot = round((time - self._start) * self._rate)
        self._last = time
        if slot <= self._slot:
            return None
        self._slot = slot
        return slot
