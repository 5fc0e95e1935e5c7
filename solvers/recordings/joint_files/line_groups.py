"""Group the lines of a table by the numbers in some of its columns."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array


def grouped(numbers: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the first line of each group of equal ones, in order, and the group of each.

    Parameters
    ----------
    numbers : shape (n_lines, n_columns), whole numbers, NaN where missing
    """
    _, first, groups = np.unique(
        np.nan_to_num(numbers).astype(int), axis=0, return_index=True, return_inverse=True
    )
    rank = np.argsort(np.argsort(first))
    return np.sort(first), rank[groups.ravel()]


def first_repeated_line(cells: tuple[NDArray[np.intp], ...]) -> int | None:
    """Return the first line that has the person, frame and joint of another one; else None."""
    order = np.lexsort(cells)
    ordered = np.stack(cells)[:, order]
    is_same = (np.diff(ordered) == 0).all(axis=0)
    return int(order[1:][is_same].min()) if is_same.any() else None
