"""Write progress and failures of the command line on stderr."""

import io
import sys
from collections.abc import Iterable, Iterator
from typing import TextIO, TypeVar

from ...faults import escaped

T = TypeVar("T")
MIN_STEP = 0.01


def escape_undecodable_names(stream: TextIO) -> None:
    """Let a stream escape what it cannot encode, such as names of files, as stderr does."""
    if isinstance(stream, io.TextIOWrapper):
        stream.reconfigure(errors="backslashreplace")


def printable(text: str) -> str:
    """Return text with escaped control characters, except line ends."""
    return "\n".join(map(escaped, text.split("\n")))


class Screen:
    """Stderr with a progress line, if it is a terminal."""

    def __init__(self, stream: TextIO | None = None) -> None:
        self.stream = sys.stderr if stream is None else stream
        self.is_terminal = self.stream.isatty()
        self.title = ""
        self._shown = ""
        self._fraction = -1.0

    def progress(self, fraction: float, message: str = "") -> None:
        """Show the progress of `title` on one line, which is overwritten."""
        if not self.is_terminal or (self._shown and abs(fraction - self._fraction) < MIN_STEP):
            return
        self._fraction = fraction
        line = f"{self.title} {100 * fraction:3.0f} % {message}"
        self._replace(escaped(line)[:78])

    def counted(self, ends: Iterable[T], n_tasks: int) -> Iterator[T]:
        """Yield the ends of tasks, at least one, and show meanwhile how many are done."""
        self._show_count(0, n_tasks)
        for n_done, end in enumerate(ends, start=1):
            self.clear()
            yield end
            self._show_count(n_done, n_tasks)
        self.clear()

    def write_line(self, sentence: str) -> None:
        """Print a sentence on a line of its own."""
        self.clear()
        self.stream.write(f"{escaped(sentence)}\n")
        self.stream.flush()

    def note(self, sentence: str) -> None:
        """Print a sentence only if stderr is a terminal."""
        if self.is_terminal:
            self.write_line(sentence)

    def clear(self) -> None:
        """Clear the progress line."""
        if self._shown:
            self._replace("")

    def _show_count(self, n_done: int, n_tasks: int) -> None:
        self.title = f"[{n_done}/{n_tasks}]"
        self.clear()
        self.progress(n_done / n_tasks)

    def _replace(self, line: str) -> None:
        self.stream.write("\r" + line.ljust(len(self._shown)) + ("" if line else "\r"))
        self.stream.flush()
        self._shown = line
