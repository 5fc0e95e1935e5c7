"""Make names unique and printable, for formats that allow equal or damaged names."""

MAX_NAME_LENGTH = 1000
"""Maximum letters in a name; a longer one is damaged data."""
MAX_SHOWN_LENGTH = 40


class UniqueNames:
    """Make names unique: the second `hand` becomes `hand_2`."""

    def __init__(self) -> None:
        self._taken: set[str] = set()
        self._next: dict[str, int] = {}

    def give(self, stem: str, ending: str = "") -> str:
        """Return `stem + ending`, with a number between them if that name is taken.

        Numbers continue from the last one, so that many equal names take linear time.
        """
        wanted = name = f"{stem}{ending}"
        number = self._next.get(wanted, 2)
        while name in self._taken:
            name, number = f"{stem}_{number}{ending}", number + 1
        self._next[wanted] = number
        self._taken.add(name)
        return name


def printable(name: str) -> str:
    """Return a name without control characters."""
    return "".join(letter for letter in name if letter.isprintable())


def shown(name: str) -> str:
    """Return a name shortened and printable, for a message."""
    name = printable(name)
    return name if len(name) <= MAX_SHOWN_LENGTH else f"{name[:MAX_SHOWN_LENGTH]}..."
