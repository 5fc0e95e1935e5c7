"""Group the lines of a table by the numbers in some of its columns."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...progress import Progress
from ..conventions import rate_of_numbers
from ..point_bodies import second_of_times
from .long_columns import LongColumns

MAX_SPREAD = 100
"""Frames for each one with a line, a ratio, up to which missing numbers are frames without a
body. It bounds the memory of damaged files."""


def group_equal_lines(numbers: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
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
    """Return the first line that has the person, frame and joint, (n_lines,) each, of another
    one; else None."""
    order = np.lexsort(cells)
    ordered = np.stack(cells)[:, order]
    is_same = (np.diff(ordered) == 0).all(axis=0)
    return int(order[1:][is_same].min()) if is_same.any() else None


def frames_of_lines(
    rows: Array, columns: LongColumns, rate: float | None, progress: Progress
) -> tuple[NDArray[np.intp], Array | None, float | None]:
    """Return the frame of each line, -1 where it has none, and times or rate of the frames.

    Numbers between those of the file are frames without a body. Times are in seconds; None
    where the file has none. The rate is that of its numbers (`rate_of_numbers`).

    Parameters
    ----------
    rows : shape (n_lines, n_columns)
    columns : LongColumns
    rate : float, Hz, or None
        As the file states it.
    progress : Progress
    """
    key = rows[:, columns.time if columns.frame is None else columns.frame]
    known, index = np.unique(key, return_inverse=True)
    known = known[np.isfinite(known)]
    if columns.frame is not None and len(known) > 1:
        step = np.diff(known).min()
        with np.errstate(over="ignore"):
            spread = np.rint((known - known[0]) / step)
        if spread[-1] < len(known) * MAX_SPREAD:
            index = np.append(spread.astype(int), -1)[np.minimum(index, len(known))]
    frames = np.where(np.isfinite(key), index, -1)
    numbers = np.arange(frames.max(initial=-1) + 1)
    if columns.time is not None:
        times = np.full(len(numbers), np.nan)
        times[frames[frames >= 0]] = rows[frames >= 0, columns.time]
        if (is_known := np.isfinite(times)).any():
            times = np.interp(numbers, numbers[is_known], times[is_known])
            second = columns.times.second or second_of_times(times, progress)
            return frames, times * second, rate
    return frames, None, rate_of_numbers(known.tolist(), rate, progress)
