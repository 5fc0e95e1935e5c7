"""Read tables whose cells are separated by tabs, semicolons or commas."""

import re
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...progress import Progress, unwatched
from .growing_table import GrowingTable
from .line_reader import LineReader
from .text import ROWS_AT_ONCE, parse_rows

SEPARATORS = (b"\t", b";", b",", b"|")
SPACE = b" "
"""Separator of lines without any other."""
QUOTED = re.compile(rb'"([^"]*)"')
NO_CONVERTERS: Mapping[int, Callable[[bytes], bytes]] = MappingProxyType({})
INSIDE_QUOTES = b"\0"
"""Replaces separators inside quotes while a line is split."""


def ignored_columns(
    width: int, used: Collection[int | None]
) -> dict[int, Callable[[bytes], bytes]]:
    """Return converters that leave out all other columns, which may hold words."""
    return {column: lambda cell: b"" for column in range(width) if column not in used}


def find_separator(line: bytes) -> bytes:
    """Return the separator that is most frequent in a line, outside quotes."""
    plain = QUOTED.sub(b"", line)
    found = max(SEPARATORS, key=plain.count)
    return found if found in plain or SPACE not in plain.strip() else SPACE


def split_cells(line: bytes, separator: bytes) -> list[bytes]:
    """Return the cells of a line, without quotes and surrounding space."""
    if separator == SPACE:
        return line.split()
    if b'"' not in line:
        return [cell.strip() for cell in line.split(separator)]
    line = QUOTED.sub(lambda match: match[1].replace(separator, INSIDE_QUOTES), line)
    cells = line.split(separator)
    return [cell.replace(INSIDE_QUOTES, separator).strip(b' \t"') for cell in cells]


def stream_cells(
    reader: LineReader,
    separator: bytes,
    width: int,
    path: Path | str,
    progress: Progress = unwatched,
    *,
    is_end: Callable[[bytes], bool] = lambda line: False,
    keep_blank: bool = False,
    converters: Mapping[int, Callable[[bytes], bytes]] = NO_CONVERTERS,
    prepare: Callable[[bytes], bytes] = bytes,
) -> NDArray[np.float64]:
    """Read the numbers of each remaining line, up to a line that ends the table.

    Blank cells, and cells that a short line lacks, are NaN; blank lines are skipped. Numbers
    may have decimal commas if cells are quoted or separated by tabs or semicolons.

    Parameters
    ----------
    reader : LineReader
    separator : bytes
    width : int
        Cells per row.
    path : Path or str
        For error messages.
    progress : Progress
    is_end : callable
        Returns whether a line begins another part of the file.
    keep_blank : bool
        Whether a line of blank cells is a row of NaN; otherwise it is skipped.
    converters : mapping of column to callable
        Returns the number for a cell that is a word; blank for NaN.
    prepare : callable
        Returns a line as one of the cells that are wanted.

    Returns
    -------
    float array, shape (n_rows, width)

    Raises
    ------
    InvalidFileError
        A row has more cells than the header, or a cell is not a number.
    """
    table = GrowingTable(width)
    for block in reader.rest():
        for part in block.parts(ROWS_AT_ONCE):
            lines: list[bytes] = []
            ended = False
            for number, line in enumerate(part.lines, start=part.first):
                ended = is_end(line)
                if ended:
                    break
                row = prepare(line)
                spaced = _cells_between_spaces(
                    row, separator, width, converters, f"{path}, line {number}"
                )
                is_row = spaced or (keep_blank and separator in line)
                lines.append(spaced or b"nan " * width if is_row else b"")
            numbers = range(part.first, part.first + len(lines))
            table.add(parse_rows(lines, width, path, numbers), part.stop)
            progress(part.stop, "Reading")
            if ended:
                return table.rows()
    return table.rows()


def _cells_between_spaces(
    line: bytes,
    separator: bytes,
    width: int,
    converters: Mapping[int, Callable[[bytes], bytes]],
    location: str,
) -> bytes:
    """Return the cells of a line separated by spaces, blank ones as `nan`; empty for none."""
    cells = split_cells(line, separator)
    if not any(cells):
        return b""
    if any(cells[width:]):
        raise InvalidFileError(
            f"{location}: {len(cells)} cells instead of {width}. The file is damaged, or has"
            " decimal commas; export it again with decimal points."
        )
    for column, convert in converters.items():
        if column < len(cells):
            cells[column] = convert(cells[column])
    words = [cell.replace(b",", b".") or b"nan" for cell in cells[:width]]
    return b" ".join(words + [b"nan"] * (width - len(words)))
