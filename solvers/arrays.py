"""The array types that every family shares, and blocks of rows that fit into memory."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""Numbers in double precision; docstrings give the shape and the unit."""
Single = NDArray[np.float32]
"""Numbers in single precision."""
Flags = NDArray[np.bool_]
"""Whether something holds, by frame, joint or pixel."""
Integers = NDArray[np.intp]
"""Indices and counts."""

MAX_BLOCK_VALUES = 1 << 20
"""Number of values of a temporary array. It bounds the memory: 8 MB in double precision."""


def row_blocks(n_rows: int, values_per_row: int) -> Iterator[slice]:
    """Yield consecutive slices of rows whose values are few enough to be in memory at once."""
    step = max(MAX_BLOCK_VALUES // max(values_per_row, 1), 1)
    for start in range(0, n_rows, step):
        yield slice(start, min(start + step, n_rows))
