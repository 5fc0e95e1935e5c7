"""Collect the first frames of a stream, in which the actor is measured."""

from collections.abc import Callable, Iterable
from typing import Generic, TypeVar

from ...recordings.streams import StreamFrame

MAX_FIRST_FRAMES = 8192
"""Number of frames that are kept. It bounds the memory of the fastest streams."""

Frame = TypeVar("Frame", bound=StreamFrame)


class FirstFrames(Generic[Frame]):
    """Frames that continue each other, for a time.

    Parameters
    ----------
    duration : float, seconds
    continues : callable
        Return whether a frame shows the same body soon after the last one.
    """

    def __init__(self, duration: float, continues: Callable[[Frame, Frame], bool]) -> None:
        self._duration, self._continues = duration, continues
        self._frames: list[Frame] = []

    @property
    def fraction(self) -> float:
        """Fraction of the time that is covered, 0 to 1."""
        if not self._frames:
            return 0.0
        return min((self._frames[-1].time - self._frames[0].time) / self._duration, 1.0)

    def collect(self, frames: Iterable[Frame]) -> list[Frame]:
        """Return all frames once they cover the time, and begin again; otherwise none."""
        for frame in frames:
            if self._frames and not self._continues(self._frames[-1], frame):
                self._frames.clear()
            self._frames.append(frame)
        del self._frames[:-MAX_FIRST_FRAMES]
        if self.fraction < 1.0:
            return []
        complete, self._frames = self._frames, []
        return complete
