"""What the command line says on stderr: progress for people, one sentence per failure."""

import io
import sys
from typing import TextIO

from ..faults import escaped

SMALLEST_STEP = 0.01


def escape_odd_names(stream: TextIO) -> None:
    """Let a stream write file names that it cannot encode, escaped as stderr does."""
    if isinstance(stream, io.TextIOWrapper) and stream.errors == "strict":
        stream.reconfigure(errors="backslashreplace")


def printable(text: str) -> str:
    """Return text for people, in which names have no control characters: only lines end."""
    return "\n".join(map(escaped, text.split("\n")))


class Screen:
    """Stderr, with a last line that shows progress where somebody may be looking."""

    def __init__(self, stream: TextIO | None = None) -> None:
        self.stream = sys.stderr if stream is None else stream
        self.watched = self.stream.isatty()
        self.title = ""
        self._shown = ""
        self._fraction = -1.0

    def progress(self, fraction: float, message: str = "") -> None:
        """Show how far the file of `title` is, on one line that is written over."""
        if not self.watched or abs(fraction - self._fraction) < SMALLEST_STEP:
            return
        self._fraction = fraction
        line = f"{self.title} {100 * fraction:3.0f} % {message}"
        self._replace(escaped(line)[:78])

    def say(self, sentence: str) -> None:
        """Print a sentence on a line of its own."""
        self.clear()
        self.stream.write(f"{escaped(sentence)}\n")
        self.stream.flush()

    def note(self, sentence: str) -> None:
        """Say something that only a person who is watching needs."""
        if self.watched:
            self.say(sentence)

    def clear(self) -> None:
        """Take the progress away."""
        if self._shown:
            self._replace("")

    def _replace(self, line: str) -> None:
        self.stream.write("\r" + line.ljust(len(self._shown)) + ("" if line else "\r"))
        self.stream.flush()
        self._shown = line
