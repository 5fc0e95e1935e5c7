"""Text files of numbers: opened, cut into lines and read fast, whatever their line ends."""

import mmap
import warnings
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...files import open_regular, unreadable
from ...progress import Progress, unwatched
from .names import shown

ROWS_AT_ONCE = 2000
BYTE_ORDER_MARK = b"\xef\xbb\xbf"
MISSING = {b"nan", b"-nan", b"inf", b"-inf", b"null", b"none", b"-"}


def map_bytes(path: Path | str) -> bytes | mmap.mmap:
    """Return the file as bytes that are read when they are asked for.

    Raises
    ------
    InvalidFileError
        There is no such file, or it cannot be read.
    """
    path = Path(path)
    if not path.is_file():
        raise InvalidFileError(f"There is no file {path}.")
    try:
        with open_regular(path) as file:
            return mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
    except ValueError:  # An empty file cannot be mapped.
        return b""
    except OSError as error:
        raise unreadable(path, error) from None


def read_bytes(path: Path | str) -> bytes:
    """Return the whole file; raises InvalidFileError where there is none."""
    path = Path(path)
    if not path.is_file():
        raise InvalidFileError(f"There is no file {path}.")
    try:
        with open_regular(path) as file:
            return file.read().removeprefix(BYTE_ORDER_MARK)
    except OSError as error:
        raise unreadable(path, error) from None


def spaces_from_commas(line: bytes) -> bytes:
    """Return a line parted by commas, parted by blanks; empty places are not a number."""
    if not line.strip():
        return b""
    return b" ".join(word.strip() or b"nan" for word in line.split(b","))


def read_rows(
    lines: Sequence[bytes],
    width: int,
    path: Path | str,
    line_numbers: Sequence[int],
    progress: Progress = unwatched,
) -> NDArray[np.float64]:
    """Read one row of numbers per line; blank lines are passed over.

    Parameters
    ----------
    lines : sequence of bytes
    width : int
        How many numbers each row must have.
    path : Path or str
        For error messages.
    line_numbers : sequence of int
        Number of each of these lines in its file, counted from 1; likewise.
    progress : Progress

    Returns
    -------
    float array, shape (n_rows, width)
        What the file calls not a number or infinite is NaN.

    Raises
    ------
    InvalidFileError
        A row is too short or too long, or holds something that is no number.
    """
    parts = [np.empty((0, width))]
    for start in range(0, len(lines), ROWS_AT_ONCE):
        block = slice(start, start + ROWS_AT_ONCE)
        parts.append(parse_rows(lines[block], width, path, line_numbers[block]))
        progress(min(1.0, (start + ROWS_AT_ONCE) / len(lines)), "Reading")
    return np.concatenate(parts)


def parse_rows(
    lines: Sequence[bytes], width: int, path: Path | str, line_numbers: Sequence[int]
) -> NDArray[np.float64]:
    """Read one row of numbers per line, as `read_rows` does: all lines at once."""
    rows = _read_block(lines, width, path, line_numbers)
    rows[np.isinf(rows)] = np.nan
    return rows


def _read_block(
    lines: Sequence[bytes], width: int, path: Path | str, line_numbers: Sequence[int]
) -> NDArray[np.float64]:
    filled = [line for line in lines if line.strip()]
    if not filled:
        return np.empty((0, width))
    try:
        with warnings.catch_warnings():  # It warns where it sees nothing but control codes.
            warnings.simplefilter("ignore", UserWarning)
            rows = np.loadtxt(filled, comments=None, ndmin=2)
        if rows.shape == (len(filled), width):
            return rows
    except ValueError:
        pass  # Line by line it is seen which line is wrong, or merely unusual.
    read = [
        _read_line(line, width, f"{path}, line {number}")
        for number, line in zip(line_numbers, lines, strict=True)
        if line.strip()
    ]
    return np.array(read)


def _read_line(line: bytes, width: int, place: str) -> list[float]:
    words = [word.encode("latin-1") for word in line.decode("latin-1").split()]  # as numpy
    if len(words) != width:
        raise InvalidFileError(
            f"{place}: {len(words)} numbers stand where {width} belong. The file is damaged or"
            " cut short; export it again, or delete that line."
        )
    return [read_number(word, place) for word in words]


def read_number(word: bytes, place: str) -> float:
    """Return the number that a word means, with a decimal point or comma; NaN for none.

    Raises
    ------
    InvalidFileError
        It is no number; `place` says where it stands.
    """
    # The old Windows runtime wrote 1.#QNAN.
    if not word or word.lower() in MISSING or b"#" in word:
        return np.nan
    try:
        return float(word.replace(b",", b"."))
    except ValueError:
        what = shown(word.decode("ascii", "backslashreplace"))
        raise InvalidFileError(
            f"{place}: {what!r} is not a number. The file is damaged; export it again."
        ) from None
