"""Text files a block of lines at a time: a large one is never in memory as text."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from ...errors import InvalidFileError
from ...files import open_regular, unreadable
from .text import BYTE_ORDER_MARK

BLOCK_BYTES = 1 << 22
"""Bytes that are read at once."""
MAX_LINE_BYTES = 1 << 24
"""Bytes; what is longer is no line of numbers."""


class Block(NamedTuple):
    """Some lines of a file."""

    first: int
    """Number of the first line, counted from 1."""
    lines: list[bytes]
    """Without their ends, be they of Unix, Windows or old Macs."""
    start: float
    stop: float
    """Where they begin and end, 0 to 1, by the bytes of the file."""

    def parts(self, most: int) -> Iterator["Block"]:
        """Yield the same lines, no more than so many at a time."""
        per_byte = (self.stop - self.start) / max(1, _count_bytes(self.lines))
        start = self.start
        for at in range(0, len(self.lines), most):
            lines = self.lines[at : at + most]
            stop = start + per_byte * _count_bytes(lines)
            yield Block(self.first + at, lines, start, stop)
            start = stop


class LineReader:
    """The lines of a file: a few to look at, one to take, and the rest in blocks.

    Parameters
    ----------
    path : Path or str

    Raises
    ------
    InvalidFileError
        There is no such file, it cannot be read, or a line in it does not end.
    """

    def __init__(self, path: Path | str) -> None:
        self._blocks = _blocks(Path(path))
        self._lines: list[bytes] = []
        self._at = 0
        self._before = 0  # lines of the file before those that are held
        self._start = self._stop = 0.0
        self._more()

    @property
    def n_taken(self) -> int:
        """How many lines have been taken."""
        return self._before + self._at

    def peek(self, n_lines: int = 1) -> list[bytes]:
        """Return the next lines, fewer at the end; they are not taken."""
        more = True
        while more and len(self._lines) - self._at < n_lines:
            more = self._more()
        return self._lines[self._at : self._at + n_lines]

    def take(self, n_lines: int = 1) -> list[bytes]:
        """Return the next lines, fewer at the end."""
        taken = self.peek(n_lines)
        self._at += len(taken)
        return taken

    def pass_over_blank(self) -> None:
        """Take lines until one that is not blank comes next."""
        while (line := self.peek()) and not line[0].strip():
            self._at += 1

    def rest(self) -> Iterator[Block]:
        """Yield all lines that are left."""
        while self._at < len(self._lines) or self._more():
            lines, first = self._lines[self._at :], self.n_taken + 1
            self._at = len(self._lines)
            yield Block(first, lines, self._start, self._stop)
            del lines

    def _more(self) -> bool:
        """Hold one block more; return whether there was one."""
        further = next(self._blocks, None)
        if further is None:
            return False
        self._before += self._at
        if self._at == len(self._lines):
            self._start = self._stop
        lines, self._stop = further
        self._lines = self._lines[self._at :] + lines
        self._at = 0
        return True


def _blocks(path: Path) -> Iterator[tuple[list[bytes], float]]:
    """Yield whole lines, and which share of the file has been read."""
    if not path.is_file():
        raise InvalidFileError(f"There is no file {path}.")
    try:
        with open_regular(path) as file:
            size = max(1, file.seek(0, 2))
            file.seek(0)
            mark = file.read(len(BYTE_ORDER_MARK))
            begun = [] if mark == BYTE_ORDER_MARK else [mark]  # a line that goes on
            while block := file.read(BLOCK_BYTES):
                end = _end_of_lines(block)
                if end:
                    lines = b"".join([*begun, block[:end]]).splitlines()
                    yield lines, min(1.0, file.tell() / size)
                    begun = []
                begun.append(block[end:])
                if sum(map(len, begun)) > MAX_LINE_BYTES:
                    raise InvalidFileError(
                        f"{path} holds a line of more than {MAX_LINE_BYTES >> 20} MB. It is"
                        " damaged; export it again."
                    )
            if lines := b"".join(begun).splitlines():
                yield lines, 1.0
    except OSError as error:
        raise unreadable(path, error) from None


def _count_bytes(lines: list[bytes]) -> int:
    return sum(map(len, lines)) + len(lines)


def _end_of_lines(block: bytes) -> int:
    """Return where the last line that surely ends in a block does: half of \r\n is none."""
    return max(block.rfind(b"\n"), block.rfind(b"\r", 0, len(block) - 1)) + 1
