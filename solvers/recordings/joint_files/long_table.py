"""Read tables with a line for each joint of each frame."""

import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import JointRecording, Tracks
from ...progress import Progress, unwatched, within
from ..containers import (
    NUMBER,
    LineReader,
    NumberedWords,
    check_n_joints,
    ignored_columns,
    shown,
    stream_cells,
)
from ..conventions import (
    DEFAULT_FRAME_RATE,
    Bodies,
    check_scale,
    observed_body,
    recorded_seconds,
)
from ..point_bodies import (
    TimeCells,
    TimeName,
    column_of_times,
    over_midnight,
    second_of_times,
    time_name,
)
from .point_table import recording_of_points
from .table_titles import MAX_TITLE_LINES, table_titles

FRAMES = ("frame", "frame_id", "frameid", "frame_index", "frame_number", "frame_num", "image")
JOINTS = (
    "joint", "joint_name", "jointname", "joint_id", "joint_index", "landmark", "landmark_name",
    "landmark_id", "landmark_index", "keypoint", "keypoint_name", "keypoint_id", "point",
    "point_id", "jointtype", "joint_type", "marker", "marker_name", "body_part", "bodypart",
    "bone", "name", "part", "gelenk", "knochen", "articulation", "articulación",
)  # fmt: skip
UNIT = re.compile(r"\s*[(\[]\w+[)\]]$")
"""Unit in the title of a coordinate."""
PEOPLE = (
    "person", "person_id", "body", "body_id", "track_id", "trackingid", "tracking_id",
    "subject", "skeleton_id",
)  # fmt: skip
IDENTITIES = ("id", "pid")
"""Titles of the person in tables that state a joint of a frame several times without it; others
have a number of the line or of the joint there."""
AXES = ("x", "y", "z")
AXIS_AFFIXES = (
    "{}", "pos_{}", "{}_pos", "position_{}", "{}_m", "world_{}", "{}_world", "{}3d",
    "location_{}", "translate_{}", "pos{}", "position{}", "location{}", "translate{}", "t{}",
)  # fmt: skip
"""Titles of coordinates, with the axis at the braces."""
MIN_JOINTS = 8
"""Number of joints of a body. It guards tables of something else."""
MAX_SPREAD = 100
"""Frames for each one with a line, a ratio, up to which missing numbers are frames without a
body. It bounds the memory of damaged files."""
MAX_POINTS = 1 << 27
"""Points of all people over all frames. It bounds the memory: 3 GB."""
MAX_POINTS_OF_FEW_LINES = 1 << 24
"""Points above which more than `MAX_SPREAD` for each line are refused. It bounds the memory of
damaged files: 400 MB."""


class _LongColumns(NamedTuple):
    """Columns of a table, by index; None where it has no such column."""

    frame: int | None
    time: int | None
    times: TimeCells
    joint: int
    person: int | None
    identity: int | None
    """Column that may be the person (`IDENTITIES`)."""
    axes: tuple[int, ...]


class _LongTable(NamedTuple):
    """Lines of a file, with numbers for words."""

    rows: Array
    columns: _LongColumns
    joints: NumberedWords
    people: NumberedWords
    """Words of the column of the person, otherwise of the one that may be it."""


def is_long_table(head: bytes) -> bool:
    """Return whether the first line of a file names a frame, a joint and its coordinates."""
    lines = head.lstrip(b"\r\n").splitlines()
    return len(lines) > 1 and table_titles(lines, _columns) is not None


def open_long_table(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[JointRecording | Tracks]:
    """Open a table whose lines are `frame, joint, x, y, z`, in any order of columns.

    Frames are in a column called `frame` or the like; without it, each time is one. `joint`,
    `landmark`, `marker` or the like is a name or a number; `person` or the like, that of one of
    several people, as is `id` where lines repeat a joint of a frame. Lines may be missing:
    those points are not observed. Axes and unit are estimated as in `open_point_table`.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
    progress : Progress

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, has too few joints, or one of a person twice in a frame.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    table = _read_table(path, progress)
    rows, columns = table.rows, table.columns
    frames, times = _frames(rows, columns)
    is_row = np.isfinite(rows[:, columns.joint]) & (frames >= 0)
    if not is_row.any() or len(table.joints) < MIN_JOINTS:
        raise InvalidFileError(
            f"{path} has {len(table.joints)} different joints in its lines, too few for a body."
            " Export it again."
        )
    check_n_joints(path, len(table.joints))
    names, order = table.joints.in_order()
    points = _points(path, table, frames, order)
    if times is not None:
        times = times * (columns.times.second or second_of_times(times, progress))
    duration = len(points[0]) / DEFAULT_FRAME_RATE if times is None else recorded_seconds(times)
    listed = tuple(
        observed_body(
            table.people.name(number),
            np.flatnonzero(np.isfinite(body).all(axis=2).any(axis=1)),
            len(body),
            duration,
        )
        for number, body in enumerate(points)
    )

    def read(index: int, progress: Progress) -> JointRecording | Tracks:
        return recording_of_points(path, names, points[index], times, scale, progress)

    return Bodies(str(path), listed if len(listed) > 1 else (), read)


def _read_table(path: Path | str, progress: Progress) -> _LongTable:
    reader = LineReader(path)
    reader.skip_blank_lines()
    header = table_titles(reader.peek(MAX_TITLE_LINES), _columns)
    columns = _columns(header.titles) if header else None
    if header is None or columns is None:
        raise InvalidFileError(f"{path} has no columns of points. Export it again.")
    reader.take(header.n_lines)
    titles = header.titles
    joints, people = NumberedWords(), NumberedWords()
    used = {columns.joint, columns.frame, *columns.axes}
    converters: dict[int, Callable[[bytes], bytes]] = {
        **ignored_columns(len(titles), used),
        columns.joint: joints,
    }
    person = columns.identity if columns.person is None else columns.person
    if person is not None:
        converters[person] = people
    if columns.frame is not None:
        converters[columns.frame] = _frame_number
    if columns.time is not None:
        converters[columns.time] = columns.times
    progress = within(progress, 0.0, 0.6)
    rows = stream_cells(
        reader, header.separator, len(titles), path, progress, converters=converters
    )
    second = columns.times.second
    if columns.time is not None and second is not None:
        rows[:, columns.time] = over_midnight(rows[:, columns.time] * second) / second
    return _LongTable(rows, columns, joints, people)


def _points(
    path: Path | str, table: _LongTable, frames: NDArray[np.intp], order: NDArray[np.intp]
) -> Array:
    """Return the points of all people, shape (n_people, n_frames, n_joints, 3)."""
    columns = table.columns
    is_row = np.isfinite(table.rows[:, columns.joint]) & (frames >= 0)
    rows, frames = table.rows[is_row], frames[is_row]
    joints = order[rows[:, columns.joint].astype(int)]
    cells = np.zeros(len(rows), int), frames, joints
    person = columns.person
    is_enough = len(rows) >= MIN_JOINTS * len(table.people)
    if person is None and is_enough and _first_repeated_line(cells) is not None:
        person = columns.identity
    if person is not None:
        cells = np.nan_to_num(rows[:, person]).astype(int), frames, joints
    shape = int(cells[0].max()) + 1, int(frames.max()) + 1, len(order)
    max_points = min(MAX_POINTS, max(MAX_POINTS_OF_FEW_LINES, MAX_SPREAD * len(rows)))
    if np.prod(shape, dtype=float) > max_points:
        raise InvalidFileError(
            f"{path} has {shape[2]} joints of {shape[0]} people in {shape[1]} frames, which"
            " does not fit its lines. Export it again."
        )
    repeated = _first_repeated_line(cells)
    if repeated is not None:
        joint = table.joints.name(int(rows[repeated, columns.joint]))
        raise InvalidFileError(
            f"{path} has joint {shown(joint)} of one person twice in frame"
            f" {frames[repeated] + 1}. Name the person of each line in a column `person`."
        )
    points = np.full((*shape, 3), np.nan)
    points[cells] = rows[:, list(columns.axes)]
    return points


def _first_repeated_line(cells: tuple[NDArray[np.intp], ...]) -> int | None:
    """Return the first line that has the person, frame and joint of another one; else None."""
    order = np.lexsort(cells)
    ordered = np.stack(cells)[:, order]
    is_same = (np.diff(ordered) == 0).all(axis=0)
    return int(order[1:][is_same].min()) if is_same.any() else None


def _frame_number(cell: bytes) -> bytes:
    """Return a number, or the last one in the name of a frame, such as `frame_0012.png`."""
    if NUMBER.fullmatch(cell):
        return cell
    numbers = re.findall(rb"\d+(?:\.0+)?(?=\D*$)", cell)
    return numbers[-1] if numbers else b""


def _frames(rows: Array, columns: _LongColumns) -> tuple[NDArray[np.intp], Array | None]:
    """Return the frame of each line, -1 where it has none, and the time of each frame.

    Numbers between those of the file are frames without a body.
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
    if columns.time is None or not len(known):
        return frames, None
    times = np.full(frames.max() + 1, np.nan)
    times[frames[frames >= 0]] = rows[frames >= 0, columns.time]
    if not np.isfinite(times).any():
        return frames, None
    numbers = np.arange(len(times))
    is_known = np.isfinite(times)
    return frames, np.interp(numbers, numbers[is_known], times[is_known])


def _columns(titles: Sequence[str]) -> _LongColumns | None:
    """Return the columns of such a table; None if one is missing."""
    lower = [UNIT.sub("", title).strip().lower().replace(" ", "_") for title in titles]

    def find(names: Iterable[str]) -> int | None:
        return next((lower.index(name) for name in names if name in lower), None)

    joint, frame = find(JOINTS), find(FRAMES)
    time = column_of_times(titles)
    axes = next(
        (
            tuple(map(lower.index, wanted))
            for affix in AXIS_AFFIXES
            if {*(wanted := [affix.format(axis) for axis in AXES])} <= {*lower}
        ),
        None,
    )
    if joint is None or axes is None or (frame is None and time is None):
        return None
    times = TimeCells((time_name(titles[time]) if time is not None else None) or TimeName(None))
    return _LongColumns(frame, time, times, joint, find(PEOPLE), find(IDENTITIES), axes)
