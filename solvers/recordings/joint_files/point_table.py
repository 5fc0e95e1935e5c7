"""Read tables of any program whose columns are named after points and coordinates."""

import re
from collections.abc import Callable, Collection, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import JointRecording, Tracks
from ...progress import READING, Progress, Remark, unwatched, within
from ..containers import LineReader, shown, stream_cells
from ..conventions import (
    DEFAULT_FRAME_RATE,
    Bodies,
    ConstantRate,
    MarkerSubject,
    check_scale,
    guess_unit_of_points,
    meters_from_unit_name,
    observed_body,
    recorded_seconds,
    split_subjects,
    stand_markers,
)
from ..point_bodies import (
    body_of_named_points,
    body_of_points,
    missing_limbs,
    read_body,
    second_of_times,
    stand_body,
)
from .table_titles import MAX_TITLE_LINES, MIN_POINTS, table_titles

COORDINATE = re.compile(
    r"(?P<name>.*?)([\s_.:\-]+(pos(ition)?|loc(ation)?|translat(e|ion)|tr?|world))?[\s_.:\-]*"
    r"(?P<axis>[xyz])(\s*[(\[](?P<unit>\w+)[)\]])?",
    re.IGNORECASE,
)
AXIS_FIRST = re.compile(r"(?P<axis>[xyz])[\s_.:\-]?(?P<name>\d+)", re.IGNORECASE)
NO_POSITION = re.compile(
    r"(rotation|rotate|quat(ernion)?|euler|orientation|velocity|acceleration"
    r"|(^|[\s_.:\-])(rot|orient|angles?|scale|vel|acc|gyro|mag|std|error|[qr]))$",
    re.IGNORECASE,
)
"""Ends of the names of columns that hold no positions."""
TIMES = {
    "time": None, "times": None, "timestamp": None, "t": None, "seconds": 1.0, "time_s": 1.0,
    "timestamp_s": 1.0, "time (s)": 1.0, "time(s)": 1.0, "time [s]": 1.0, "sec": 1.0,
    "time (seconds)": 1.0,
    "time_ms": 0.001, "timestamp_ms": 0.001, "time (ms)": 0.001, "milliseconds": 0.001,
}  # fmt: skip
"""Seconds per unit of a time stamp, by the title of its column; None where that does not state
it."""


class _Columns(NamedTuple):
    """Columns of a table."""

    names: tuple[str, ...]
    positions: Array
    """Column of x, y and z of each point, shape (n_points, 3)."""
    time: int | None
    second: float | None
    """Seconds per unit of the times; None if the title does not state it."""
    unit: float | None
    """Meters, by the titles; None if they do not say it."""
    width: int


def is_point_table(head: bytes) -> bool:
    """Return whether the first lines of a file name the coordinates of points."""
    lines = head.lstrip(b"\r\n").splitlines()
    if len(lines) < 2:
        return False
    columns = _columns(table_titles(lines).titles)
    return columns is not None and len(columns.names) >= MIN_POINTS


def open_point_table(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[JointRecording | Tracks]:
    """Open a table with a column for x, y and z of each point, a line for each frame.

    Columns are called `LeftHand_x`, `Hip_position_x`, `nose.X`, `Head X (mm)` or `x0`; others
    are left out. Names may also stand above the axes, in a line of their own (`table_titles`).
    Points that form a body, by their names or, if these are numbers, by their bones
    (`name_joints`), are its joints. Their axes, and their unit if it is not stated, are
    estimated from the body. Without a column of times, 30 Hz are assumed. Points of several
    people are called `Anna:Head_x`.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
    progress : Progress

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or has no points that are observed.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    reader = LineReader(path)
    reader.skip_blank_lines()
    first = reader.peek(MAX_TITLE_LINES)
    header = table_titles(first) if first else None
    columns = _columns(header.titles) if header else None
    if header is None or columns is None:
        raise InvalidFileError(f"{path} has no columns of points. Export it again.")
    reader.take(header.n_lines)
    rows = stream_cells(
        reader,
        header.separator,
        columns.width,
        path,
        within(progress, 0.0, 0.8),
        converters=ignored_columns(columns.width, {*columns.positions.flat, columns.time}),
    )
    points = rows[:, columns.positions.astype(int)]
    times = None if columns.time is None else rows[:, columns.time]
    if times is None or not np.isfinite(times).all():
        times = None
    else:
        times = times * (columns.second or second_of_times(times, progress))
    unit = columns.unit if scale is None else scale
    people = _people(columns.names, points, progress) if np.isfinite(points).any() else []
    duration = len(points) / DEFAULT_FRAME_RATE if times is None else recorded_seconds(times)
    listed = tuple(
        observed_body(
            each.name,
            np.flatnonzero(np.isfinite(points[:, each.columns]).any(axis=(1, 2))),
            len(points),
            duration,
        )
        for each in people
    )

    def read(index: int, progress: Progress) -> JointRecording | Tracks:
        if not people:
            return recording_of_points(path, columns.names, points, times, unit, progress)
        person = people[index]
        mine = points[:, person.columns]
        return recording_of_points(path, person.names, mine, times, unit, progress)

    return Bodies(str(path), listed, read)


def ignored_columns(
    width: int, used: Collection[int | None]
) -> dict[int, Callable[[bytes], bytes]]:
    """Return converters that leave out all other columns, which may hold words."""
    return {column: lambda cell: b"" for column in range(width) if column not in used}


def _people(names: tuple[str, ...], points: Array, progress: Progress) -> list[MarkerSubject]:
    """Return the people whose names begin those of the points; empty for a single one."""
    people, others = list[MarkerSubject](), list[str]()
    for each in split_subjects(names):
        if body_of_named_points(each.names, points[:, each.columns]) is None:
            others.append(each.name)
        else:
            people.append(each)
    if len(people) < 2:
        return []
    if others:
        progress(
            0.8,
            Remark(
                f"Left out, since they are no complete bodies: {shown(', '.join(others))}. To"
                " import their points as markers, store each in a table of its own"
            ),
        )
    return people


def recording_of_points(
    path: Path | str,
    names: tuple[str, ...],
    points: Array,
    times: Array | None,
    unit: float | None,
    progress: Progress,
) -> JointRecording | Tracks:
    """Return named or numbered points as the joints of a body, or as markers if they are none.

    Parameters
    ----------
    path : Path or str
    names : tuple of str
    points : shape (n_frames, n_points, 3), in the unit and axes of the file
    times : shape (n_frames,), seconds, or None
    unit : float, meters per unit of the file, or None
    progress : Progress

    Raises
    ------
    InvalidFileError
        No point has all its coordinates in any frame.
    """
    points = np.where(np.isfinite(points).all(axis=-1, keepdims=True), points, np.nan)
    if not len(points) or np.isnan(points).all():
        raise InvalidFileError(f"{path} has no points that are observed in any frame.")
    if all(name.isdigit() for name in names):
        unnamed = body_of_points(path, points)
        if unnamed is not None:
            return read_body(path, unnamed, unit, progress, times)
    if times is None:
        progress(0.8, Remark(f"The file has no times; {DEFAULT_FRAME_RATE:g} Hz is assumed"))
    body = body_of_named_points(names, points)
    if body is not None:
        return stand_body(
            path, body.names, body.positions, times=times, scale=unit, progress=progress
        )
    if lacking := missing_limbs(names):
        progress(
            0.8,
            Remark(
                f"The points lack {', '.join(lacking)} of a body and are imported as markers;"
                " export these joints too"
            ),
        )
    rate = DEFAULT_FRAME_RATE
    if times is not None:
        resampler = ConstantRate(path, times)
        points, rate = resampler.positions(points), resampler.frame_rate
    unit = guess_unit_of_points(points) if unit is None else unit
    progress(1.0, READING)
    return stand_markers(names, points * unit, rate, unit, "")


def _columns(titles: Sequence[str]) -> _Columns | None:
    """Return the columns of points; None if none has all three coordinates."""
    found: dict[str, dict[str, int]] = {}
    units: set[str] = set()
    for column, title in enumerate(titles):
        match = AXIS_FIRST.fullmatch(title) or COORDINATE.fullmatch(title)
        name = match["name"].strip(" _.:-") if match else ""
        if match is None or not name or NO_POSITION.search(name):
            continue
        found.setdefault(name, {}).setdefault(match["axis"].lower(), column)
        units.add(match.groupdict().get("unit") or "")
    points = {name: axes for name, axes in found.items() if len(axes) == 3}
    if not points:
        return None
    lower = [title.lower() for title in titles]
    time = next((column for column, title in enumerate(lower) if title in TIMES), None)
    unit = meters_from_unit_name(units.pop()) if len(units) == 1 else None
    positions = np.array([[axes[axis] for axis in "xyz"] for axes in points.values()])
    second = None if time is None else TIMES[lower[time]]
    return _Columns(tuple(points), positions, time, second, unit, len(titles))
