"""A table whose number of rows is not known before all are read."""

import numpy as np
from numpy.typing import NDArray

SPARE_RATIO = 1.02
"""Room that is made for rows that are somewhat shorter, in characters, than the first."""
GROWTH_RATIO = 1.3


class GrowingTable:
    """Rows of numbers, in memory once: room is made for the end of the file from the first.

    Parameters
    ----------
    width : int
    """

    def __init__(self, width: int) -> None:
        self._table = np.empty((0, width))
        self._n_rows = 0

    def add(self, rows: NDArray[np.float64], share: float = 1.0) -> None:
        """Append rows, shape (n, width); with them, that share of the file has been read."""
        stop = self._n_rows + len(rows)
        if stop > len(self._table):
            enough = int(SPARE_RATIO * stop / share) if share > 0.0 else stop
            if self._n_rows:  # They got shorter.
                enough = min(enough, int(GROWTH_RATIO * stop))
            self._resize(max(stop, enough))
        self._table[self._n_rows : stop] = rows
        self._n_rows = stop

    def rows(self) -> NDArray[np.float64]:
        """Return all rows, shape (n_rows, width); nothing can be added afterwards."""
        self._resize(self._n_rows)
        return self._table

    def _resize(self, n_rows: int) -> None:
        # In place: where the system can, without a copy.
        self._table.resize((n_rows, self._table.shape[1]), refcheck=False)
