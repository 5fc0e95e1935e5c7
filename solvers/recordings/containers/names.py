"""Names that differ from each other, for formats that let two joints be called the same."""

MAX_NAME_LENGTH = 1000
"""Letters in a name; what is longer is something else that was damaged."""
MAX_SHOWN_LENGTH = 40


class UniqueNames:
    """Hands out every name once: the second `hand` is called `hand_2`."""

    def __init__(self) -> None:
        self._taken: set[str] = set()
        self._next: dict[str, int] = {}

    def give(self, stem: str, ending: str = "") -> str:
        """Return `stem + ending`, or with a number between them where that is taken.

        Numbers go on from the last one given, so that a file of many equal names is read in
        time proportional to its length.
        """
        wanted = name = f"{stem}{ending}"
        number = self._next.get(wanted, 2)
        while name in self._taken:
            name, number = f"{stem}_{number}{ending}", number + 1
        self._next[wanted] = number
        self._taken.add(name)
        return name


def printable(name: str) -> str:
    """Return a name without the control characters that damaged files have in them."""
    return "".join(letter for letter in name if letter.isprintable())


def shown(name: str) -> str:
    """Return a name, or whatever stands where one belongs, as a sentence may quote it."""
    name = printable(name)
    return name if len(name) <= MAX_SHOWN_LENGTH else f"{name[:MAX_SHOWN_LENGTH]}..."
