"""Tables of numbers out of text files that may be larger than the memory."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...progress import Progress, unwatched
from .growing_table import GrowingTable
from .line_reader import LineReader
from .text import ROWS_AT_ONCE, parse_rows


def stream_rows(
    reader: LineReader,
    width: int,
    path: Path | str,
    progress: Progress = unwatched,
    *,
    tidied: Callable[[bytes], bytes] | None = None,
) -> NDArray[np.float64]:
    """Read one row of numbers per line that is left; blank lines are passed over.

    Beside the rows there is only a block of the file in memory.

    Parameters
    ----------
    reader : LineReader
    width : int
        How many numbers each row must have.
    path : Path or str
        For error messages.
    progress : Progress
    tidied : function of a line
        Returns it with its numbers parted by blanks, if they are not.

    Returns
    -------
    float array, shape (n_rows, width)
        What the file calls not a number or infinite is NaN.

    Raises
    ------
    InvalidFileError
        A row is too short or too long, or holds something that is no number.
    """
    table = GrowingTable(width)
    for block in reader.rest():
        for part in block.parts(ROWS_AT_ONCE):
            lines = part.lines if tidied is None else [tidied(line) for line in part.lines]
            numbers = range(part.first, part.first + len(lines))
            table.add(parse_rows(lines, width, path, numbers), part.stop)
            progress(part.stop, "Reading")
    progress(1.0, "Reading")
    return table.rows()
