"""Read tables of numbers from text files of any size."""

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
    normalize: Callable[[bytes], bytes] | None = None,
) -> NDArray[np.float64]:
    """Read one row of numbers per remaining line; blank lines are skipped.

    In addition to the rows, only one block of the file is in memory.

    Parameters
    ----------
    reader : LineReader
    width : int
        Required numbers per row.
    path : Path or str
        For error messages.
    progress : Progress
    normalize : callable, optional
        Returns a line with its numbers separated by spaces.

    Returns
    -------
    float array, shape (n_rows, width)
        NaN for not-a-number and infinity.

    Raises
    ------
    InvalidFileError
        A row has too few or too many values, or a value is not a number.
    """
    table = GrowingTable(width)
    for block in reader.rest():
        for part in block.parts(ROWS_AT_ONCE):
            lines = (
                part.lines if normalize is None else [normalize(line) for line in part.lines]
            )
            numbers = range(part.first, part.first + len(lines))
            table.add(parse_rows(lines, width, path, numbers), part.stop)
            progress(part.stop, "Reading")
    progress(1.0, "Reading")
    return table.rows()
