"""Read tables of any program whose columns are named after points and coordinates."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import JointRecording, Tracks
from ...progress import Progress, Remark, unwatched, within
from ..containers import LineReader, ignored_columns, shown, stream_cells
from ..conventions import (
    DEFAULT_FRAME_RATE,
    Bodies,
    MarkerSubject,
    are_frame_numbers,
    check_scale,
    meters_from_unit_name,
    observed_body,
    rate_of_numbers,
    recorded_seconds,
    split_subjects,
    step_between,
)
from ..identities import follow_columns
from ..point_bodies import (
    Coordinate,
    TimeCells,
    TimeName,
    are_joints,
    body_of_named_points,
    column_of_times,
    completed_times,
    coordinate_of_title,
    groups_by_suffix,
    is_frame_title,
    names_of_positions,
    numbered_axes,
    over_midnight,
    second_of_times,
    time_name,
    without_letter,
)
from .long_columns import number_of_frame
from .points_recording import recording_of_points, refuse_other_points
from .table_titles import (
    MAX_TITLE_LINES,
    MIN_POINTS,
    N_PEEKED_LINES,
    N_SAMPLED_LINES,
    table_titles,
)
from .untitled_tables import numbered_titles


class _Columns(NamedTuple):
    """Columns of a table."""

    names: tuple[str, ...]
    positions: Array
    """Column of x, y and z of each point, shape (n_points, 3)."""
    time: int | None
    times: TimeCells
    frame: int | None
    """Column of the numbers of frames."""
    unit: float | None
    """Meters, by the titles; None if they do not say it."""
    width: int


def is_point_table(head: bytes) -> bool:
    """Return whether the first lines of a file name the coordinates of points."""
    lines = head.lstrip(b"\r\n").splitlines()
    if len(lines) < 2:
        return False
    complete = lines if head.endswith((b"\n", b"\r")) else lines[:-1]
    return (table_titles(lines, has_points) or numbered_titles(complete)) is not None


def open_point_table(
    path: Path | str,
    *,
    scale: float | None = None,
    progress: Progress = unwatched,
    lines: list[bytes] | None = None,
) -> Bodies[JointRecording | Tracks]:
    """Open a table with a column for x, y and z of each point, a line for each frame.

    Columns are called `LeftHand_x`, `Hip_position_x`, `nose.X`, `Head X (mm)` or `x0`; others
    are left out. Names may also stand above the axes, in a line of their own (`table_titles`).
    Points that form a body, by their names or, if these are numbers, by their bones
    (`name_joints`), are its joints; a table of numbers without titles may be one of these.
    Their axes, and their unit if it is not stated, are estimated from the body. Without a
    column of times, 30 Hz are assumed. Points of several people are called `Anna:Head_x`.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
    progress : Progress
    lines : list of bytes, optional
        The table as text, if the file holds it otherwise.

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
    reader = LineReader(path, lines)
    reader.skip_blank_lines()
    first = reader.peek(MAX_TITLE_LINES + N_PEEKED_LINES)
    header = table_titles(first, has_points) or numbered_titles(first)
    columns = (
        _columns(header.titles, header.cells(first[: MAX_TITLE_LINES + N_SAMPLED_LINES]))
        if header
        else None
    )
    if header is None or columns is None:
        raise InvalidFileError(f"{path} has no columns of points. Export it again.")
    reader.take(header.n_lines)
    rows = stream_cells(
        reader,
        header.separator,
        columns.width,
        path,
        within(progress, 0.0, 0.8),
        converters={
            **ignored_columns(columns.width, {*columns.positions.flat}),
            **({} if columns.frame is None else {columns.frame: number_of_frame}),
            **({} if columns.time is None else {columns.time: columns.times}),
        },
        prepare=header.expand,
    )
    if columns.time is not None:  # Lines such as of means may follow.
        rows = rows[: columns.times.n_frames(rows[:, columns.time])]
    times = None if columns.time is None else _times(rows[:, columns.time], columns, progress)
    points = rows[:, columns.positions.astype(int)]
    rate = header.rate
    if times is None:
        times, rate = _numbered_times(rows, columns, header.rate, progress)
    unit = columns.unit if scale is None else scale
    people = _people(columns.names, points, progress) if np.isfinite(points).any() else []
    points = follow_columns(people, points, times, progress)
    seconds = len(points) / (rate or DEFAULT_FRAME_RATE)
    duration = seconds if times is None else recorded_seconds(times)
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
        if not header.n_lines:
            refuse_other_points(path, points)
        if not people:
            return recording_of_points(path, columns.names, points, times, unit, progress, rate)
        person = people[index]
        mine = points[:, person.columns]
        return recording_of_points(path, person.names, mine, times, unit, progress, rate)

    return Bodies(str(path), listed if len(listed) > 1 else (), read)


def _times(times: Array, columns: _Columns, progress: Progress) -> Array | None:
    """Return the times of frames, seconds; None if there are hardly any."""
    second = columns.times.second or second_of_times(times, progress)
    return completed_times(over_midnight(times * second), progress)


def _numbered_times(
    rows: Array, columns: _Columns, rate: float | None, progress: Progress
) -> tuple[Array | None, float | None]:
    """Return the times of frames, seconds, by their numbers if these increase, and the rate.

    Without a rate both are None, unless the numbers leave some out.
    """
    counted = np.arange(len(rows), dtype=np.float64)
    numbers = counted if columns.frame is None else rows[:, columns.frame]
    is_increasing = len(rows) > 1 and bool((np.diff(numbers) >= 1.0).all())
    if rate is None:
        is_gapless = not is_increasing or bool((np.diff(numbers) == 1.0).all())
        if is_gapless or not are_frame_numbers(numbers.tolist()):
            return None, None
        rate = DEFAULT_FRAME_RATE
        progress(0.8, Remark(f"The file has no times; {DEFAULT_FRAME_RATE:g} Hz is assumed"))
    if not is_increasing:
        return None, rate
    step = step_between(numbers.tolist()) or 1.0
    rate = rate_of_numbers(numbers.tolist(), rate, progress)
    return np.asarray((numbers - numbers[0]) / step / rate), rate


def _people(names: tuple[str, ...], points: Array, progress: Progress) -> list[MarkerSubject]:
    """Return the people whose names begin or end those of the points; empty for one of all.

    Of points called like both ends of bones, one person has those where bones start.
    """
    people, others = list[MarkerSubject](), list[str]()
    by_suffix = [MarkerSubject(*group) for group in groups_by_suffix(names, points)]
    for each in by_suffix or split_subjects(names):
        if body_of_named_points(each.names, points[:, each.columns]) is None:
            others.append(each.name)
        else:
            people.append(each)
    if len(people) < 2 and not (people and len(by_suffix) == 1):
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


def has_points(titles: Sequence[str]) -> bool:
    """Return whether titles of columns are those of points."""
    columns = _columns(titles)
    return columns is not None and (
        len(columns.names) >= MIN_POINTS or are_joints(columns.names)
    )


def _points_of(
    coordinates: Mapping[int, Coordinate],
) -> tuple[dict[str, dict[str, int]], set[str]]:
    """Return the columns of the axes of each point that has all three, and the units."""
    found: dict[str, dict[str, int]] = {}
    for column, each in coordinates.items():
        found.setdefault(each.name, {}).setdefault(each.axis, column)
    complete = [name for name, axes in found.items() if len(axes) == 3]
    names = names_of_positions(complete)
    points = {
        plain: found[name] for plain, name in zip(without_letter(names), names, strict=True)
    }
    return points, {each.unit for each in coordinates.values()}


def _columns(titles: Sequence[str], cells: Sequence[Sequence[str]] = ()) -> _Columns | None:
    """Return the columns of points; None if none has all three coordinates."""
    coordinates = {
        column: coordinate
        for column, title in enumerate(titles)
        if (coordinate := coordinate_of_title(title)) is not None
    }
    in_room = {column: each for column, each in coordinates.items() if each.is_in_room}
    points, units = _points_of(in_room)
    if len(points) < MIN_POINTS:
        points, units = _points_of(coordinates)
    points = points or numbered_axes(titles)
    if not points:
        return None
    time = column_of_times(titles, cells)
    times = TimeCells((time_name(titles[time]) if time is not None else None) or TimeName(None))
    frame = next((at for at, title in enumerate(titles) if is_frame_title(title)), None)
    unit = meters_from_unit_name(units.pop()) if len(units) == 1 else None
    positions = np.array([[axes[axis] for axis in "xyz"] for axes in points.values()])
    return _Columns(tuple(points), positions, time, times, frame, unit, len(titles))
