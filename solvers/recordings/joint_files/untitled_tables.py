"""Recognize tables of numbers without titles by the number of their columns."""

from collections.abc import Sequence
from itertools import chain, product

from ..containers import NUMBER, SPACE, find_separator, is_missing
from ..conventions import are_frame_numbers
from ..point_bodies import has_layout, is_increasing
from .table_titles import MIN_POINTS, N_SAMPLED_LINES, TableTitles, cells_of_line


def numbered_titles(lines: Sequence[bytes]) -> TableTitles | None:
    """Return titles for a table that has none: `0_x` and so on for the joints of a body.

    Its lines are numbers, as many as a known order of joints has coordinates, perhaps after
    the number or the time of the frame. The fourth value of a joint is its confidence.
    """
    rows = [line for line in lines[:N_SAMPLED_LINES] if line.strip()]
    separator = find_separator(rows[0]) if rows else SPACE
    cells = [cells_of_line(line, separator) for line in rows]
    width = len(cells[0]) if rows else 0
    if any(len(row) != width for row in cells) or not all(map(_is_numeric, chain(*cells))):
        return None
    stamps = ((), ("time",), ("frame",), ("frame", "time"))
    for n_values, above in product((3, 4), stamps):
        n_joints, rest = divmod(width - len(above), n_values)
        is_counted = all(is_increasing(column, cells) for column in range(len(above)))
        is_counted &= above != ("time",) or not _are_numbered(cells)
        if rest == 0 and n_joints >= MIN_POINTS and has_layout(n_joints) and is_counted:
            axes = [
                f"{joint}_{axis}" for joint in range(n_joints) for axis in "xyzc"[:n_values]
            ]
            return TableTitles([*above, *axes], 0, separator)
    return None


def _are_numbered(rows: Sequence[Sequence[str]]) -> bool:
    """Return whether the first cells are the numbers of frames."""
    first = [row[0] for row in rows]
    is_number = len(first) > 1 and all(map(str.isdigit, first))
    return is_number and are_frame_numbers([*map(float, first)])


def _is_numeric(cell: str) -> bool:
    return is_missing(cell.encode()) or NUMBER.fullmatch(cell.encode()) is not None
