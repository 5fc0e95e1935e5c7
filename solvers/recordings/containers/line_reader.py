"""Read text files in blocks of lines, with one block in memory at a time."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from ...errors import InvalidFileError
from ...files import open_regular, unreadable_error
from .text import BYTE_ORDER_MARK, WIDE_MARKS, as_utf8

BLOCK_BYTES = 1 << 22
"""Bytes per read."""
MAX_LINE_BYTES = 1 << 24
"""Maximum length of a line of numbers, bytes."""


class Block(NamedTuple):
    """Consecutive lines of a file."""

    first: int
    """Number of the first line, counted from 1."""
    lines: list[bytes]
    """Without Unix, Windows or old Mac line ends."""
    start: float
    stop: float
    """Start and end as fractions of the file's bytes."""

    def parts(self, max_lines: int) -> Iterator["Block"]:
        """Yield the same lines in blocks of at most `max_lines`."""
        per_byte = (self.stop - self.start) / max(1, _count_bytes(self.lines))
        start = self.start
        for at in range(0, len(self.lines), max_lines):
            lines = self.lines[at : at + max_lines]
            stop = start + per_byte * _count_bytes(lines)
            yield Block(self.first + at, lines, start, stop)
            start = stop


class LineReader:
    """The lines of a file: peek at the next ones, take some, and read the rest in blocks.

    Parameters
    ----------
    path : Path or str
    lines : list of bytes, optional
        Text that a file of another format was converted to; the file is not opened.

    Raises
    ------
    InvalidFileError
        The file is missing or unreadable, or a line is too long.
    """

    def __init__(self, path: Path | str, lines: list[bytes] | None = None) -> None:
        self._blocks = _blocks(Path(path)) if lines is None else iter([(lines, 1.0)])
        self._lines: list[bytes] = []
        self._at = 0
        self._before = 0  # lines of the file before those in memory
        self._start = self._stop = 0.0
        self._load_block()

    @property
    def n_taken(self) -> int:
        """Number of lines taken so far."""
        return self._before + self._at

    def peek(self, n_lines: int = 1) -> list[bytes]:
        """Return the next lines without taking them; fewer at the end."""
        more = True
        while more and len(self._lines) - self._at < n_lines:
            more = self._load_block()
        return self._lines[self._at : self._at + n_lines]

    def take(self, n_lines: int = 1) -> list[bytes]:
        """Take and return the next lines; fewer at the end."""
        taken = self.peek(n_lines)
        self._at += len(taken)
        return taken

    def skip_blank_lines(self) -> None:
        """Take lines until the next one is not blank."""
        while (line := self.peek()) and not line[0].strip():
            self._at += 1

    def rest(self) -> Iterator[Block]:
        """Yield all remaining lines."""
        while self._at < len(self._lines) or self._load_block():
            lines, first = self._lines[self._at :], self.n_taken + 1
            self._at = len(self._lines)
            yield Block(first, lines, self._start, self._stop)
            del lines

    def _load_block(self) -> bool:
        """Load the next block; return whether there was one."""
        next_block = next(self._blocks, None)
        if next_block is None:
            return False
        self._before += self._at
        if self._at == len(self._lines):
            self._start = self._stop
        lines, self._stop = next_block
        self._lines = self._lines[self._at :] + lines
        self._at = 0
        return True


def _blocks(path: Path) -> Iterator[tuple[list[bytes], float]]:
    """Yield complete lines, and the fraction of the file read so far."""
    if not path.is_file():
        raise InvalidFileError(f"There is no file {path}.")
    try:
        with open_regular(path) as file:
            size = max(1, file.seek(0, 2))
            file.seek(0)
            mark = file.read(len(BYTE_ORDER_MARK))
            if mark.startswith(WIDE_MARKS):
                yield as_utf8(mark + file.read()).splitlines(), 1.0
                return
            incomplete = [] if mark == BYTE_ORDER_MARK else [mark]
            while block := file.read(BLOCK_BYTES):
                end = _end_of_lines(block)
                if end:
                    lines = b"".join([*incomplete, block[:end]]).splitlines()
                    yield lines, min(1.0, file.tell() / size)
                    incomplete = []
                incomplete.append(block[end:])
                if sum(map(len, incomplete)) > MAX_LINE_BYTES:
                    raise InvalidFileError(
                        f"{path} has a line of more than {MAX_LINE_BYTES >> 20} MB. It is"
                        " damaged; export it again."
                    )
            if lines := b"".join(incomplete).splitlines():
                yield lines, 1.0
    except OSError as error:
        raise unreadable_error(path, error) from None


def _count_bytes(lines: list[bytes]) -> int:
    return sum(map(len, lines)) + len(lines)


def _end_of_lines(block: bytes) -> int:
    """Return the end of the last complete line; a final \r may be half of \r\n."""
    return max(block.rfind(b"\n"), block.rfind(b"\r", 0, len(block) - 1)) + 1
