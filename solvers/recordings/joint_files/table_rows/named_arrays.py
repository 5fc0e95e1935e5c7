"""Choose the array of positions next to a list of the names of joints."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from ....arrays import Array
from ....progress import Remark
from ...containers import printable, shown
from ...point_bodies import (
    is_other_array,
    key_of_root,
    n_known_names,
    rank_of_array,
    time_name,
)
from ..json_bodies import is_no_position, is_number
from .titled_rows import TitledRows

MIN_NAMES = 8
"""Number of names of joints. It guards lists of other words."""
UNCLEAR_PATHS = {"position", "transform"}
"""Keys that may be those of the path of a body, or of a camera or anything else."""
Listed = tuple[str, list[Any]]
"""A list and its key."""


def named_arrays(lists: Sequence[Listed]) -> Iterator[TitledRows]:
    """Yield arrays of positions with the names of their joints, the likeliest first.

    Names with the most roles in a body come first, and arrays with a row for each frame before
    flat ones. Times, rotations, rest poses and the like (`is_other_array`) are not positions,
    whatever their shape; of several arrays the best is taken (`rank_of_array`), and the remark
    of the table says which.

    Parameters
    ----------
    lists : sequence of keys and lists
        All that are next to each other in a file.
    """
    names = [each for _, each in lists if _are_names(each)]
    names.sort(key=lambda each: -n_known_names(each))
    arrays = [*_arrays(lists)] if names else []
    for is_flat in (False, True):
        for each in names:
            fitting = [
                (key, array.reshape(-1, 3 * len(each)))
                for key, array in arrays
                if _fits(array, len(each)) and (array.ndim == 1) is is_flat
            ]
            if fitting:
                yield _table(each, fitting, lists)


def _are_names(values: list[Any]) -> bool:
    """Return whether these are different words, as many as a body has joints."""
    is_listed = len({*map(str, values)}) == len(values) >= MIN_NAMES
    return is_listed and all(isinstance(each, str) for each in values)


def _arrays(lists: Sequence[Listed]) -> Iterator[tuple[str, Array]]:
    """Yield the lists of numbers that may be positions, the best first."""
    for key, values in sorted(lists, key=lambda each: rank_of_array(each[0])):
        if time_name(key) or is_no_position(key) or is_other_array(key):
            continue
        try:
            array = np.array(values, dtype=np.float64)
        except (ValueError, TypeError, OverflowError):
            continue
        if array.size:
            yield key, array


def _fits(array: Array, n_joints: int) -> bool:
    """Return whether an array has the coordinates of joints, in rows or in one list."""
    is_shaped = array.shape[1:] in {(n_joints, 3), (3 * n_joints,), ()}
    return is_shaped and array.size % (3 * n_joints) == 0


def _table(
    names: Sequence[str], fitting: Sequence[tuple[str, Array]], lists: Sequence[Listed]
) -> TitledRows:
    """Return the first of arrays with times and the path of the body, if these are next to it.

    They are if they have a value for each frame.
    """
    titles = [f"{printable(name)}_{axis}" for name in names for axis in "xyz"]
    rows: list[Any] = fitting[0][1].tolist()
    others = ", ".join(key for key, _ in fitting[1:])
    remark = _remark_of_choice(fitting[0][0], others) if others else None
    per_frame = {key: values for key, values in lists if len(values) == len(rows)}
    root = key_of_root(key for key in per_frame if key.lower() not in UNCLEAR_PATHS)
    if root is not None and all(map(_is_point, per_frame[root])):
        titles += [f"{printable(root)}_{axis}" for axis in "xyz"]
        rows = [[*row, *each] for row, each in zip(rows, per_frame[root], strict=True)]
    clock = next(filter(time_name, per_frame), None)
    if clock is not None:
        titles = [clock, *titles]
        rows = [[time, *row] for time, row in zip(per_frame[clock], rows, strict=True)]
    return TitledRows(titles, rows, remark)


def _is_point(value: Any) -> bool:
    return isinstance(value, list) and len(value) == 3 and all(map(is_number, value))


def _remark_of_choice(key: str, others: str) -> Remark:
    return Remark(f"Positions are read from {shown(key)}, and not from {shown(others)}")
