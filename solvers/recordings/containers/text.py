"""Read text files of numbers with any line ends."""

import mmap
import warnings
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...files import open_regular, unreadable_error
from ...progress import Progress, unwatched
from .names import shown

ROWS_AT_ONCE = 2000
BYTE_ORDER_MARK = b"\xef\xbb\xbf"
WIDE_MARKS = (b"\xff\xfe", b"\xfe\xff")
"""Byte-order marks of UTF-16, in which Excel and PowerShell save text."""
EAST_ASIAN = ("shift_jis", "gbk")
BODY_LETTERS = frozenset(
    "左右腰骨盤盆上下半身背脊椎柱胸首頭头颈鎖锁肩膀肘腕手股関关節节膝盖足踝脚趾尖先髋臀胯臂腿前親人中薬小指目部爪"
    "ひじざつまセンター"
)
"""Letters in Japanese and Chinese names of joints, by which their encoding is recognized."""
MISSING = {b"nan", b"n/a", b"na", b"-nan", b"inf", b"-inf", b"null", b"none", b"-"}


def is_missing(cell: bytes) -> bool:
    """Return whether a cell is blank or says that it has no number, as `NaN` and `1.#QNAN` do.

    The latter is what the old Windows runtime wrote.
    """
    word = cell.strip().lower()
    return not word or word in MISSING or b".#" in word


def decode_text(line: bytes) -> str:
    """Decode a line of UTF-8 or, failing that, of Latin-1, which any bytes are.

    Names of joints in Shift-JIS or GBK are recognized by their letters.
    """
    try:
        return line.decode()
    except UnicodeDecodeError:
        return max(_decodings(line), key=_is_of_body)


def as_utf8(content: bytes) -> bytes:
    """Return the content of a file without byte-order mark, in UTF-8 if it was in UTF-16."""
    if content.startswith(WIDE_MARKS):
        return content.decode("utf-16", "replace").encode()
    return content.removeprefix(BYTE_ORDER_MARK)


def _decodings(line: bytes) -> Iterator[str]:
    yield line.decode("latin-1")
    for encoding in EAST_ASIAN:
        with suppress(UnicodeDecodeError):
            yield line.decode(encoding)


def _is_of_body(text: str) -> bool:
    """Return whether most letters beyond ASCII are those of joints in Japanese or Chinese."""
    letters = [letter for letter in text if not letter.isascii()]
    return sum(letter in BODY_LETTERS for letter in letters) > len(letters) / 2


def map_bytes(path: Path | str) -> bytes | mmap.mmap:
    """Return the file as memory-mapped bytes.

    Raises
    ------
    InvalidFileError
        The file is missing or unreadable.
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
        raise unreadable_error(path, error) from None


def read_bytes(path: Path | str) -> bytes:
    """Return the complete file; raise InvalidFileError if it is missing or unreadable."""
    path = Path(path)
    if not path.is_file():
        raise InvalidFileError(f"There is no file {path}.")
    try:
        with open_regular(path) as file:
            return as_utf8(file.read())
    except OSError as error:
        raise unreadable_error(path, error) from None


def spaces_from_commas(line: bytes) -> bytes:
    """Replace the commas of a line by spaces; empty cells become NaN."""
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
    """Read one row of numbers per line; blank lines are skipped.

    Parameters
    ----------
    lines : sequence of bytes
    width : int
        Required numbers per row.
    path : Path or str
        For error messages.
    line_numbers : sequence of int
        Number of each line in its file, counted from 1.
    progress : Progress

    Returns
    -------
    float array, shape (n_rows, width)
        NaN for not-a-number and infinity.

    Raises
    ------
    InvalidFileError
        A row has too few or too many values, or a value is not a number.
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
    """Parse lines of `width` numbers, as `read_rows` does, all at once: (n_lines, width)."""
    rows = _read_block(lines, width, path, line_numbers)
    rows[np.isinf(rows)] = np.nan
    return rows


def _read_block(
    lines: Sequence[bytes], width: int, path: Path | str, line_numbers: Sequence[int]
) -> NDArray[np.float64]:
    nonblank = [line for line in lines if line.strip()]
    if not nonblank:
        return np.empty((0, width))
    try:
        with warnings.catch_warnings():  # loadtxt warns about lines of control codes.
            warnings.simplefilter("ignore", UserWarning)
            rows = np.loadtxt(nonblank, comments=None, ndmin=2)
        if rows.shape == (len(nonblank), width):
            return rows
    except ValueError:
        pass  # Parse line by line, to report the invalid line or accept unusual numbers.
    read = [
        _read_line(line, width, f"{path}, line {number}")
        for number, line in zip(line_numbers, lines, strict=True)
        if line.strip()
    ]
    return np.array(read)


def _read_line(line: bytes, width: int, location: str) -> list[float]:
    words = [word.encode("latin-1") for word in line.decode("latin-1").split()]  # as numpy
    if len(words) != width:
        raise InvalidFileError(
            f"{location}: {len(words)} numbers instead of {width}. The file is damaged or cut"
            " short; export it again, or delete that line."
        )
    return [read_number(word, location) for word in words]


def read_number(word: bytes, location: str) -> float:
    """Parse a number with a decimal point or comma; NaN for missing values.

    Raises
    ------
    InvalidFileError
        It is not a number; the message begins with the location.
    """
    if is_missing(word):
        return np.nan
    try:
        return float(word.replace(b",", b"."))
    except ValueError:
        what = shown(word.decode("ascii", "backslashreplace"))
        raise InvalidFileError(
            f"{location}: {what!r} is not a number. The file is damaged; export it again."
        ) from None
