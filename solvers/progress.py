"""How a solver tells the outside world how far it is."""

from typing import Protocol

READING = "Reading"
"""What readers say of their work when there is nothing else to say."""


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


def overheard(progress: Progress, told: list[str]) -> Progress:
    """Return a Progress that also writes down what a reader says of a recording when done.

    Parameters
    ----------
    progress : Progress
    told : list of str
        Gets what goes beyond `READING`, as that lengths are taken for millimetres.
    """

    def listening(fraction: float, message: str = "") -> None:
        if fraction >= 1.0 and message not in ("", READING, *told):
            told.append(message)
        progress(fraction, message)

    return listening
