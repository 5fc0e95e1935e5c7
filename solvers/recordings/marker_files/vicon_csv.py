"""Read the CSV export of Vicon Nexus and Workstation: the section of trajectories."""

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...errors import InvalidFileError
from ...motion import Tracks
from ...progress import Progress, unwatched, within
from ..containers import (
    NUMBER,
    LineReader,
    decode_text,
    find_separator,
    read_number,
    split_cells,
    stream_cells,
)
from ..conventions import (
    MILLIMETER,
    Bodies,
    bodies_of_markers,
    check_scale,
    meters_from_unit_name,
    stand_markers,
)
from .marker_rows import at_constant_rate, mark_missing

SECTIONS = (b"trajectories", b"devices", b"model outputs", b"joints", b"segments", b"events")
"""First cells of the parts of a file, in lower case."""
BLANK = rb'["\t;, ]*'
HEAD = re.compile(
    rb'(?i)["\s]*(?:title[^\r\n]*[\r\n]+(?:[a-z]+:[^\r\n]*[\r\n]+)*\s*)?(?:'
    + b"|".join(SECTIONS) + rb")" + BLANK
    + rb'[\r\n]+["\s]*\d+(?:[.,]\d+)?' + BLANK + rb"(?:Hz" + BLANK + rb")?[\r\n]"
)  # fmt: skip
"""Workstation writes a title, a date and notes above, and the unit of the rate."""
HEADER_LINES = 4
"""Section, rate, names and axes; Nexus adds a line of units."""
AXES = ("x", "y", "z")


class _ViconHeader(NamedTuple):
    """The lines above the frames of trajectories."""

    rate: float
    separator: bytes
    labels: list[str]
    columns: list[int]
    """First column of each marker."""
    units: list[float]
    """Meters per unit of each marker."""
    width: int


def is_vicon_csv(head: bytes) -> bool:
    """Return whether a file begins with the name of a section and its rate."""
    return HEAD.match(head) is not None


def open_vicon_csv(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[Tracks]:
    """List the subjects of a Vicon CSV; read in meters, Z up, missing markers are NaN.

    A marker is missing if one of its cells is blank or not a number, or if it is exactly at
    the origin. Skipped frame numbers are gaps. Nexus has Z up; eight or more markers of a file
    with Y up are recognized by the body (`estimate_axes_of_points`). Other sections are not
    read.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: the units in the line above the frames, millimeters without it.
    progress : Progress

    Returns
    -------
    Bodies of Tracks
        Names are unique, and without the prefix of the actor (`Anna:LFHD`).

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or has no trajectories.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    reader = LineReader(path)
    header = _read_header(reader, path)
    rows = stream_cells(
        reader,
        header.separator,
        header.width,
        path,
        within(progress, 0.0, 0.8),
        is_end=_begins_section,
    )
    if not len(rows):
        raise InvalidFileError(f"{path} has trajectories but no frames. Export it again.")
    used = np.array(header.columns)[:, None] + np.arange(3)
    points = rows[:, used]
    mark_missing(points, path)
    points *= np.array(header.units)[:, None] if scale is None else scale
    points, rate = at_constant_rate(
        points, rows[:, 0], np.full(len(rows), np.nan), header.rate, path
    )
    progress(1.0, "Reading")
    unit = header.units[0] if scale is None else scale
    tracks = stand_markers(header.labels, points, rate, unit, "+Z")
    return bodies_of_markers(path, tracks, header.labels)


def _begins_section(line: bytes) -> bool:
    return line[:1].strip(b' "').isalpha() and _first_cell(line) in SECTIONS


def _first_cell(line: bytes) -> bytes:
    return split_cells(line, find_separator(line))[0].lower()


def _read_header(reader: LineReader, path: Path | str) -> _ViconHeader:
    """Skip to the trajectories, and read the lines above their frames."""
    while (line := reader.peek()) and _first_cell(line[0]) != SECTIONS[0]:
        reader.take()
    lines, n_line = reader.take(HEADER_LINES), reader.n_taken - 2
    if len(lines) < HEADER_LINES:
        raise InvalidFileError(
            f"{path} has no trajectories of markers, or ends in their header. Export it from"
            " Nexus with Trajectories."
        )
    separator = find_separator(lines[3])
    rate, names, axes = (split_cells(line, separator) for line in lines[1:])
    columns = [at for at in range(1, len(axes) - 2) if _is_marker(axes[at : at + 3])]
    if not columns:
        raise InvalidFileError(
            f"{path} has no columns X, Y and Z of a marker. Export it again, with Trajectories."
        )
    names += [b""] * (len(axes) - len(names))
    units = _take_units(reader, separator)
    units += [b""] * (len(axes) - len(units))
    return _ViconHeader(
        rate=read_number(rate[0], f"{path}, line {n_line}, rate"),
        separator=separator,
        labels=[decode_text(names[at]) for at in columns],
        columns=columns,
        units=[meters_from_unit_name(decode_text(units[at])) or MILLIMETER for at in columns],
        width=len(axes),
    )


def _take_units(reader: LineReader, separator: bytes) -> list[bytes]:
    """Take the line of units, if there is one, and return its cells."""
    cells = [cell for line in reader.peek() for cell in split_cells(line, separator)]
    has_units = any(cells) and not any(NUMBER.fullmatch(cell) for cell in cells)
    return cells if has_units and reader.take() else []


def _is_marker(cells: list[bytes]) -> bool:
    return tuple(decode_text(cell).lower() for cell in cells) == AXES
