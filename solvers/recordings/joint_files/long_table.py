"""Read tables with a line for each joint of each frame."""

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import JointRecording, Tracks
from ...progress import Progress, unwatched, within
from ..containers import (
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
from ..identities import follow_arrays
from ..point_bodies import (
    N_POINTS,
    landmark_columns,
    over_midnight,
    recording_from_landmarks,
)
from .line_groups import MAX_SPREAD, first_repeated_line, frames_of_lines, group_equal_lines
from .long_columns import LongColumns, long_columns, number_of_frame, number_or_missing
from .mediapipe_csv import mediapipe_landmark
from .points_recording import recording_of_points
from .table_titles import MAX_TITLE_LINES, N_SAMPLED_LINES, table_titles

NUMBERED_JOINT = re.compile(r"[0-9]{1,4}")
MAX_WORD_COLUMNS = 4
"""Number of columns of words that may distinguish lines. It bounds the memory and the tries."""
MIN_JOINTS = 8
"""Number of joints of a body. It guards tables of something else."""
MAX_POINTS = 1 << 27
"""Points of all people over all frames. It bounds the memory: 3 GB."""
MAX_POINTS_OF_FEW_LINES = 1 << 24
"""Points above which more than `MAX_SPREAD` for each line are refused. It bounds the memory of
damaged files: 400 MB."""


class _LongTable(NamedTuple):
    """Lines of a file, with numbers for words."""

    rows: Array
    columns: LongColumns
    words: dict[int, NumberedWords]
    """Words of the joints, and of the columns that distinguish people."""
    rate: float | None
    """Frames per second; None if the table does not state it."""

    @property
    def joints(self) -> NumberedWords:
        """Words of the joints."""
        return self.words[self.columns.joint]


def is_long_table(head: bytes) -> bool:
    """Return whether the first line of a file names a frame, a joint and its coordinates."""
    lines = head.lstrip(b"\r\n").splitlines()
    return len(lines) > 1 and table_titles(lines, long_columns) is not None


def open_long_table(
    path: Path | str,
    *,
    scale: float | None = None,
    progress: Progress = unwatched,
    lines: list[bytes] | None = None,
) -> Bodies[JointRecording | Tracks]:
    """Open a table whose lines are `frame, joint, x, y, z`, in any order of columns.

    Frames are in a column called `frame` or the like; without it, each time is one. `joint`,
    `landmark`, `marker` or the like is a name or a number; `person` or the like, that of one of
    several people, as is `id` where lines repeat a joint of a frame; so are words of other
    columns. Lines may be missing: those points are not observed. Landmarks of MediaPipe are
    read as its other files are (`recording_from_landmarks`). Axes and unit are estimated as in
    `open_point_table`.

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
        The file is missing, damaged, has too few joints, or one of a person twice in a frame.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    table = _read_table(LineReader(path, lines), path, progress)
    rows, columns = table.rows, table.columns
    frames, times, rate = frames_of_lines(rows, columns, table.rate, progress)
    is_row = np.isfinite(rows[:, columns.joint]) & (frames >= 0)
    if not is_row.any() or len(table.joints) < MIN_JOINTS:
        raise InvalidFileError(
            f"{path} has {len(table.joints)} different joints in its lines, too few for a body."
            " Export the skeleton that your program makes of them, such as BVH."
        )
    check_n_joints(path, len(table.joints))
    if len(columns.axes) == 2:
        if columns.has_landmarks:
            raise InvalidFileError(
                f"{path} has image landmarks, without true depth. Save the pose_world_landmarks"
                " of MediaPipe instead."
            )
        raise InvalidFileError(
            f"{path} holds 2D points of a picture, without depth. Save their positions in 3D."
        )
    names, order = table.joints.in_order()
    people, separate = _points(path, table, frames, order)
    points = follow_arrays(people, [*separate], times, progress)
    seconds = len(points[0]) / (rate or DEFAULT_FRAME_RATE)
    duration = seconds if times is None else recorded_seconds(times)
    listed = tuple(
        observed_body(
            person,
            np.flatnonzero(np.isfinite(body[..., :3]).all(axis=2).any(axis=1)),
            len(body),
            duration,
        )
        for person, body in zip(people, points, strict=True)
    )
    landmarks = _landmarks(names, columns.has_landmarks)

    def read(index: int, progress: Progress) -> JointRecording | Tracks:
        body = points[index]
        if landmarks is not None:
            marks = np.pad(body, ((0, 0), (0, 1), (0, 0)), constant_values=np.nan)
            return recording_from_landmarks(
                path, marks[:, landmarks], times, rate, scale, progress
            )
        return recording_of_points(path, names, body[..., :3], times, scale, progress, rate)

    return Bodies(str(path), listed if len(listed) > 1 else (), read)


def _landmarks(names: Sequence[str], has_landmarks: bool) -> list[int] | None:
    """Return the columns of MediaPipe's landmarks, -1 for missing ones; None for other joints.

    All have their names; joints that the table calls landmarks may have numbers, or lack some.
    """
    if not has_landmarks:
        return landmark_columns(names)
    numbers = [int(name) for name in names if NUMBERED_JOINT.fullmatch(name)]
    if len(numbers) == len(names):
        if max(numbers) > N_POINTS:
            return None
        first = int(max(numbers) == N_POINTS and 0 not in numbers)
        found: dict[int | None, int] = {number - first: at for at, number in enumerate(numbers)}
    else:
        found = {mediapipe_landmark(name): at for at, name in enumerate(names)}
    columns = [found.get(at, -1) for at in range(N_POINTS)]
    return columns if sum(at >= 0 for at in columns) >= MIN_JOINTS else None


def _read_table(reader: LineReader, path: Path | str, progress: Progress) -> _LongTable:
    reader.skip_blank_lines()
    first = reader.peek(MAX_TITLE_LINES + N_SAMPLED_LINES)
    header = table_titles(first[:MAX_TITLE_LINES], long_columns)
    columns = long_columns(header.titles, header.cells(first)) if header else None
    if header is None or columns is None:
        raise InvalidFileError(f"{path} has no columns of points. Export it again.")
    reader.take(header.n_lines)
    titles = header.titles
    people = [at for at in (columns.person, columns.identity) if at is not None]
    others = columns.others[:MAX_WORD_COLUMNS]
    words = {at: NumberedWords() for at in (columns.joint, *people, *others)}
    converters: dict[int, Callable[[bytes], bytes]] = {
        **ignored_columns(len(titles), {columns.confidence, *columns.axes}),
        **words,
    }
    if columns.frame is not None:
        converters[columns.frame] = number_of_frame
    if columns.time is not None:
        converters[columns.time] = columns.times
    if columns.confidence is not None:
        converters[columns.confidence] = number_or_missing
    progress = within(progress, 0.0, 0.6)
    rows = stream_cells(
        reader, header.separator, len(titles), path, progress, converters=converters
    )
    second = columns.times.second
    if columns.time is not None and second is not None:
        rows[:, columns.time] = over_midnight(rows[:, columns.time] * second) / second
    return _LongTable(rows, columns, words, header.rate)


def _points(
    path: Path | str, table: _LongTable, frames: NDArray[np.intp], order: NDArray[np.intp]
) -> tuple[list[str], Array]:
    """Return the names of people, and their points, (n_people, n_frames, n_joints, 4).

    The fourth number is the confidence, NaN where the table has none.
    """
    columns = table.columns
    is_row = np.isfinite(table.rows[:, columns.joint]) & (frames >= 0)
    rows, frames = table.rows[is_row], frames[is_row]
    joints = order[rows[:, columns.joint].astype(int)]
    names, people = _people(table, rows, frames, joints)
    cells = people, frames, joints
    shape = len(names), int(frames.max()) + 1, len(order)
    max_points = min(MAX_POINTS, max(MAX_POINTS_OF_FEW_LINES, MAX_SPREAD * len(rows)))
    if np.prod(shape, dtype=float) > max_points:
        raise InvalidFileError(
            f"{path} has {shape[2]} joints of {shape[0]} people in {shape[1]} frames, which"
            " does not fit its lines. Export it again."
        )
    repeated = first_repeated_line(cells)
    if repeated is not None:
        joint = table.joints.name(int(rows[repeated, columns.joint]))
        raise InvalidFileError(
            f"{path} has joint {shown(joint)} of one person twice in frame"
            f" {frames[repeated] + 1}. Name the person of each line in a column `person`."
        )
    points = np.full((*shape, 4), np.nan)
    points[(*cells, slice(3))] = rows[:, list(columns.axes)]
    if columns.confidence is not None:
        points[(*cells, 3)] = rows[:, columns.confidence]
    return names, points


def _people(
    table: _LongTable, rows: Array, frames: NDArray[np.intp], joints: NDArray[np.intp]
) -> tuple[list[str], NDArray[np.intp]]:
    """Return the names of people, and which one each line is of.

    Lines that repeat a joint of a person in a frame are of several people, or of several
    versions of one: those whose words differ, in one column if that makes lines unique.
    """
    columns = table.columns
    person = [] if columns.person is None else [columns.person]
    others = [at for at in columns.others if at in table.words]
    choices = [person, *([*person, at] for at in others), [*person, *others]]
    if columns.identity is not None and not person:
        is_enough = len(rows) >= MIN_JOINTS * len(table.words[columns.identity])
        choices[1:1] = [[columns.identity]] if is_enough else []
    groups = (group_equal_lines(rows[:, choice]) for choice in choices)
    unique = (
        (choice, first, people)
        for choice, (first, people) in zip(choices, groups, strict=True)
        if first_repeated_line((people, frames, joints)) is None
    )
    used, first, people = next(unique, (person, *group_equal_lines(rows[:, person])))
    names = [
        " ".join(table.words[at].name(int(np.nan_to_num(rows[line, at]))) for at in used)
        for line in first
    ]
    return [name or "1" for name in names], people
