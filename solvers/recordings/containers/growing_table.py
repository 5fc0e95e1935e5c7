"""Collect rows of numbers whose count is unknown until all are read."""

import numpy as np
from numpy.typing import NDArray

SPARE_RATIO = 1.02
"""Spare memory, as a ratio, for later rows that have fewer characters than the first. It bounds
the memory."""
GROWTH_RATIO = 1.3
"""Ratio by which memory grows when it is used up. It bounds the copies: about 4 times the
table."""


class GrowingTable:
    """A table that allocates memory for the complete file after its first rows.

    Parameters
    ----------
    width : int
    """

    def __init__(self, width: int) -> None:
        self._table = np.empty((0, width))
        self._n_rows = 0

    def add(self, rows: NDArray[np.float64], fraction_read: float = 1.0) -> None:
        """Append rows, shape (n, width), which end at this fraction of the file."""
        stop = self._n_rows + len(rows)
        if stop > len(self._table):
            expected = int(SPARE_RATIO * stop / fraction_read) if fraction_read > 0.0 else stop
            if self._n_rows:  # The rows are shorter than the first ones.
                expected = min(expected, int(GROWTH_RATIO * stop))
            self._resize(max(stop, expected))
        self._table[self._n_rows : stop] = rows
        self._n_rows = stop

    def rows(self) -> NDArray[np.float64]:
        """Return all rows, shape (n_rows, width); nothing can be added afterwards."""
        self._resize(self._n_rows)
        return self._table

    def _resize(self, n_rows: int) -> None:
        # In place, without a copy if the system supports it.
        self._table.resize((n_rows, self._table.shape[1]), refcheck=False)
