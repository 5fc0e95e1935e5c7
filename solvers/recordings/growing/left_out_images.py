"""Count the images that are left out, and report each reason in one sentence."""

from collections import Counter
from enum import Enum

from ..containers import shown


class Why(Enum):
    """Reasons to leave out an image."""

    DAMAGED = "are damaged or were removed before they were read"
    HALF_WRITTEN = "were not written completely"
    OTHER_SIZE = "are no depth of the size of the first image"
    OTHER_NAME = "have names of another recorder; one folder holds one recording"
    LATE = "were finished after later ones"


class LeftOutImages:
    """Images that were left out: their number and the first of them, by reason."""

    def __init__(self) -> None:
        self._counts: Counter[Why] = Counter()
        self._first: dict[Why, str] = {}

    def add(self, why: Why, name: str) -> None:
        """Count an image."""
        self._counts[why] += 1
        self._first.setdefault(why, name)

    def sentences(self) -> tuple[str, ...]:
        """Return a sentence for each reason."""
        return tuple(
            f"Images that {why.value}: {count}, {shown(self._first[why])} first. They are left"
            " out."
            for why, count in self._counts.items()
        )
