"""Recognize tables of numbers without titles by the number of their columns."""

from collections.abc import Sequence
from itertools import chain, product

import numpy as np

from ..containers import NUMBER, SPACE, find_separator, is_missing
from ..conventions import are_frame_numbers
from ..point_bodies import has_layout, is_increasing
from .table_titles import MIN_POINTS, N_SAMPLED_LINES, TableTitles, cells_of_line

VALUES_OF_JOINT = ("xyz", "xyzc", "xyzqqqq", "xyzqqqqc", "cxyzqqqq")
"""Values of a joint: its position, with a confidence or a tracking state, with a quaternion."""
MAX_NORM_ERROR = 0.01
"""Deviation from 1 of the length of a quaternion, a ratio. It guards positions; by rounding to
three digits, quaternions are off by 0.002."""


def numbered_titles(lines: Sequence[bytes]) -> TableTitles | None:
    """Return titles for a table that has none: `0_x` and so on for the joints of a body.

    Its lines are numbers, as many as a known order of joints has values (`VALUES_OF_JOINT`),
    perhaps after the number or the time of the frame.
    """
    rows = [line for line in lines[:N_SAMPLED_LINES] if line.strip()]
    separator = find_separator(rows[0]) if rows else SPACE
    cells = [cells_of_line(line, separator) for line in rows]
    width = len(cells[0]) if rows else 0
    if any(len(row) != width for row in cells) or not all(map(_is_numeric, chain(*cells))):
        return None
    stamps = ((), ("time",), ("frame",), ("frame", "time"))
    for values, above in product(VALUES_OF_JOINT, stamps):
        n_joints, rest = divmod(width - len(above), len(values))
        is_counted = all(is_increasing(column, cells) for column in range(len(above)))
        is_counted &= above != ("time",) or not _are_numbered(cells)
        is_counted &= rest == 0 and n_joints >= MIN_POINTS and has_layout(n_joints)
        if is_counted and _has_quaternions([row[len(above) :] for row in cells], values):
            axes = [f"{joint}_{axis}" for joint in range(n_joints) for axis in values]
            return TableTitles([*above, *axes], 0, separator)
    return None


def _has_quaternions(rows: Sequence[Sequence[str]], values: str) -> bool:
    """Return whether the values that are to be quaternions have length 1, or are all 0."""
    start, n_components = values.find("q"), values.count("q")
    if not n_components:
        return True
    numbers = np.array([
        [np.nan if is_missing(cell.encode()) else float(cell.replace(",", ".")) for cell in row]
        for row in rows
    ]).reshape(len(rows), -1, len(values))[..., start : start + n_components]
    lengths = np.linalg.norm(numbers[numbers.any(axis=-1)], axis=-1)
    is_unit = np.abs(lengths - 1.0) < MAX_NORM_ERROR
    return bool(len(lengths) and (is_unit | ~np.isfinite(lengths)).all())


def _are_numbered(rows: Sequence[Sequence[str]]) -> bool:
    """Return whether the first cells are the numbers of frames."""
    first = [row[0] for row in rows]
    is_number = len(first) > 1 and all(map(str.isdigit, first))
    return is_number and are_frame_numbers([*map(float, first)])


def _is_numeric(cell: str) -> bool:
    return is_missing(cell.encode()) or NUMBER.fullmatch(cell.encode()) is not None
