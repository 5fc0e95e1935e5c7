"""How a solver tells the outside world how far it is."""

from typing import Protocol


class Progress(Protocol):
    """Called by a solver now and then."""

    def __call__(self, fraction: float, message: str = "") -> None:
        """Note that `fraction` (0 to 1) of the work is done.

        Raises SolveCancelled when the caller no longer wants the result.
        """


def unwatched(fraction: float, message: str = "") -> None:
    """The Progress of scripts and tests: nobody looks."""


def within(progress: Progress, start: float, stop: float) -> Progress:
    """Return a Progress for a callee whose 0 to 1 is `start` to `stop` of the caller's work."""

    def partly(fraction: float, message: str = "") -> None:
        progress(start + (stop - start) * fraction, message)

    return partly
