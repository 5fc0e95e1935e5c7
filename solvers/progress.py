"""Report the progress of solvers."""

from typing import Protocol

READING = "Reading"
"""Default message of readers."""


class Remark(str):
    """A message that the report on a file repeats, such as what a reader left out."""

    __slots__ = ()


class Progress(Protocol):
    """Callback that a solver calls repeatedly."""

    def __call__(self, fraction: float, message: str = "") -> None:
        """Report that `fraction` (0 to 1) of the work is done.

        Raises SolveCancelled when the caller no longer wants the result.
        """


def unwatched(fraction: float, message: str = "") -> None:
    """Ignore progress, for scripts and tests."""


def within(progress: Progress, start: float, stop: float) -> Progress:
    """Return a Progress for a callee whose 0 to 1 is `start` to `stop` of the caller's work."""

    def partly(fraction: float, message: str = "") -> None:
        progress(start + (stop - start) * fraction, message)

    return partly


def collect_remarks(progress: Progress, remarks: list[Remark]) -> Progress:
    """Return a Progress that also collects each `Remark` once."""

    def report(fraction: float, message: str = "") -> None:
        if isinstance(message, Remark) and message not in remarks:
            remarks.append(message)
        progress(fraction, message)

    return report
