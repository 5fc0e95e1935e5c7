"""Put rows in the order of their index, and read numbers of frames or times from it."""

from collections.abc import Sequence
from math import isfinite
from typing import Any

import numpy as np

from ...conventions import FRAME_KEY, are_frame_numbers
from ...point_bodies import is_frame_title, read_time, time_name
from .titled_rows import TitledRows

INDEX = "index"
"""Title of the index of pandas, where it has no other."""


def with_index(table: TitledRows, index: Sequence[Any], title: str = INDEX) -> TitledRows:
    """Return a table in the order of its index, which becomes a column of frames or times.

    An index that counts the rows says nothing of them; so does one of other words. Where the
    table has a column of the same kind, that one is kept.

    Parameters
    ----------
    table : TitledRows
    index : sequence of anything
        Keys of the rows; empty if they have none.
    title : str
        Title of the column that is an index, too, if there is one.
    """
    table = _with_keys(table, [*map(str, index)])
    if title not in table.titles or time_name(title) or is_frame_title(title):
        return table
    at = table.titles.index(title)
    others = [[*row[:at], *row[at + 1 :]] for row in table.rows]
    titles = [*table.titles[:at], *table.titles[at + 1 :]]
    return _with_keys(TitledRows(titles, others), [str(row[at]) for row in table.rows])


def _with_keys(table: TitledRows, keys: list[str]) -> TitledRows:
    numbers = np.array([_number(key) for key in keys])
    if not len(keys) or len(keys) != len(table.rows) or not np.isfinite(numbers).all():
        return table
    order = np.argsort(numbers, kind="stable")
    steps = np.diff(numbers[order])
    if (steps <= 0.0).any():  # rows of several tables
        return table
    rows = [table.rows[at] for at in order]
    title = "frame" if are_frame_numbers(numbers[order].tolist()) else "time"
    has_time = any(map(time_name, table.titles))
    has_other = has_time or (title == "frame" and any(map(is_frame_title, table.titles)))
    is_counted = title == "frame" and bool((steps == 1.0).all())
    if has_other or is_counted:
        return TitledRows(table.titles, rows)
    cells = [_cell(keys[at]) for at in order]
    stamped = [[cell, *row] for cell, row in zip(cells, rows, strict=True)]
    return TitledRows([title, *table.titles], stamped)


def _number(key: str) -> float:
    """Return the number of a frame, or its time in any unit; NaN for other keys."""
    match = FRAME_KEY.fullmatch(key)
    return float(match[1]) if match else read_time(key, None)[0]


def _cell(key: str) -> str:
    """Return what a column of times or frames may hold of a key."""
    return key if isfinite(read_time(key, None)[0]) else repr(_number(key))
