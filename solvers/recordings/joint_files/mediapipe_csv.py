"""Read MediaPipe's world landmarks as programs save them: CSV."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import JointRecording
from ...motion.skeletons import BODY_POINTS
from ...progress import Progress, unwatched, within
from ..containers import (
    LineReader,
    decode_text,
    find_separator,
    ignored_columns,
    shown,
    split_cells,
    stream_cells,
)
from ..conventions import check_scale
from ..point_bodies import N_POINTS, recording_from_landmarks, second_of_times, time_name

CHANNELS = {"x": 0, "y": 1, "z": 2, "v": 3, "vis": 3, "visibility": 3}
PREFIX = re.compile(r"((world|pose|landmarks?|lm|kp|point)(_|(?=\d)))+")
SUFFIX = re.compile(r"_(world|m|meters)$")
NAME_FIRST = re.compile(r"(.+?)_?([xyzv]|vis|visibility)")
LETTER_FIRST = re.compile(r"([xyzv]|vis|visibility)_?(\d{1,2})")
MIN_LANDMARKS = 17
"""Number of landmarks with a column x, from which a table is one of poses. By definition more
than half of the 33 of MediaPipe."""
INDEX_TITLES = ("landmark", "landmark_index", "landmark_id", "landmark_name", "joint", "index",
                "name")  # fmt: skip
FRAME_TITLES = ("frame", "frame_number", "frame_id", "frame_idx", "frame_index")


class _Table(NamedTuple):
    """Landmarks of each frame, and the stamps of the frames."""

    points: Array
    """Shape (n_frames, 33, 4): x, y, z and visibility."""
    times: Array | None


def is_mediapipe_csv(head: bytes) -> bool:
    """Return whether the first line names the coordinates of the landmarks of a pose."""
    lines = head.lstrip().splitlines()
    titles = _titles(lines[0]) if lines else []
    if _is_long(titles):
        return sum(name.encode() in head.lower() for name in BODY_POINTS[:3]) == 3 or (
            "landmark" in titles[_index_column(titles)]
        )
    columns = _columns(titles)
    is_named = any(
        re.search("[a-z]{2}", title) for title in titles if _landmark_and_channel(title)
    )
    if not is_named and (N_POINTS - 1, 0) not in columns:
        return False  # numbered points of another tracker
    return sum(axis == 0 for _, axis in columns) >= MIN_LANDMARKS


def read_mediapipe_csv(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> JointRecording:
    """Read a table of MediaPipe's world landmarks, in meters, Z up; missing ones are NaN.

    A line is a frame, with columns such as `nose_x`, `landmark_0_x` or `x0`, or one landmark
    of a frame, with columns `frame`, `landmark`, `x`, `y` and `z`. Visibility becomes the
    confidence. Of columns in the picture and in the world (`world` in the title), the latter
    are read; landmarks of the picture alone are refused. Without a column of times, frames
    are taken to be 1 / 30 s apart.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: meters.
    progress : Progress

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or has no world landmarks.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    reader = LineReader(path)
    reader.skip_blank_lines()
    heading = b"".join(reader.take())
    separator, titles = find_separator(heading), _titles(heading)
    index = _index_column(titles) if _is_long(titles) else -1
    rows = stream_cells(
        reader,
        separator,
        len(titles),
        path,
        within(progress, 0.0, 0.9),
        converters=_converters(titles, index) if index >= 0 else {},
    )
    if not len(rows):
        raise InvalidFileError(f"{path} has a header but no frames. Export it again.")
    if index >= 0:
        table = _from_long(titles, rows, index, path, progress)
    else:
        table = _from_wide(titles, rows, progress)
    return recording_from_landmarks(path, table.points, table.times, None, scale, progress)


def _converters(titles: list[str], index: int) -> dict[int, Callable[[bytes], bytes]]:
    """Return converters of a table with a line per landmark: unused columns may hold words."""
    used = {*CHANNELS, *FRAME_TITLES, *_time_titles(titles)}
    kept = {column for column, title in enumerate(titles) if title in used}
    return {**ignored_columns(len(titles), kept), index: _landmark_number}


def _from_wide(titles: list[str], rows: Array, progress: Progress) -> _Table:
    points = np.full((len(rows), N_POINTS, 4), np.nan)
    for (landmark, channel), column in _columns(titles).items():
        points[:, landmark, channel] = rows[:, column]
    if np.isnan(points[..., 2]).all():
        points[..., 2] = np.where(np.isfinite(points[..., 0]), 0.0, np.nan)  # a picture
    return _Table(points, _times(titles, rows, progress))


def _from_long(
    titles: list[str], rows: Array, index: int, path: Path | str, progress: Progress
) -> _Table:
    key = next(title for title in (*FRAME_TITLES, *_time_titles(titles)) if title in titles)
    stamps, landmarks = rows[:, titles.index(key)], rows[:, index]
    usable = np.isin(landmarks, np.arange(N_POINTS)) & np.isfinite(stamps)
    rows, stamps, landmarks = rows[usable], stamps[usable], landmarks[usable].astype(int)
    if not len(rows):
        raise InvalidFileError(f"{path} has no landmark of a pose in any line.")
    _, first, frames = np.unique(stamps, return_index=True, return_inverse=True)
    _, lines, counts = np.unique(
        frames * N_POINTS + landmarks, return_index=True, return_counts=True
    )
    if counts.max() > 1:
        repeated = lines[counts > 1][0]
        joint = BODY_POINTS[landmarks[repeated]]
        raise InvalidFileError(
            f"{path} has joint {shown(joint)} of one person twice in frame"
            f" {frames[repeated] + 1}. Name the person of each line in a column `person`."
        )
    points = np.full((len(first), N_POINTS, 4), np.nan)
    for title, column in {title: at for at, title in enumerate(titles)}.items():
        if title in CHANNELS:
            points[frames, landmarks, CHANNELS[title]] = rows[:, column]
    return _Table(points, _times(titles, rows[first], progress))


def _times(titles: list[str], rows: Array, progress: Progress) -> Array | None:
    for title, second in _time_titles(titles).items():
        times = rows[:, titles.index(title)]
        if np.isfinite(times).sum() > 1:
            return np.asarray(times * (second or second_of_times(times, progress)))
    return None


def _time_titles(titles: list[str]) -> dict[str, float | None]:
    """Return the titles of times and their seconds per unit, None where not stated; last."""
    found = {title: name.second for title in titles if (name := time_name(title))}
    return dict(sorted(found.items(), key=lambda each: each[1] is None))


def _titles(line: bytes) -> list[str]:
    """Return the titles of the columns in lower case, with underscores between words."""
    cells = split_cells(line, find_separator(line))
    return [re.sub(r"[^a-z0-9]+", "_", decode_text(cell).lower()).strip("_") for cell in cells]


def _is_long(titles: list[str]) -> bool:
    return (
        {"x", "y"} <= set(titles)
        and _index_column(titles) >= 0
        and bool({*FRAME_TITLES, *_time_titles(titles)} & set(titles))
    )


def _index_column(titles: list[str]) -> int:
    return next((titles.index(title) for title in INDEX_TITLES if title in titles), -1)


def _landmark_number(cell: bytes) -> bytes:
    """Return the number of a landmark that is named; a number remains one."""
    name = re.sub(r"[^a-z0-9]+", "_", decode_text(cell).lower()).strip("_")
    if name in BODY_POINTS:
        return str(BODY_POINTS.index(name)).encode()
    return cell if cell.isdigit() else b""


def _columns(titles: list[str]) -> dict[tuple[int, int], int]:
    """Return columns by landmark and channel: those of the world, if there are any."""
    in_world = [at for at, title in enumerate(titles) if "world" in title.split("_")]
    found: dict[tuple[int, int], int] = {}
    for at in in_world or range(len(titles)):
        if key := _landmark_and_channel(titles[at]):
            found.setdefault(key, at)
    numbers = {landmark for landmark, _ in found}
    if N_POINTS in numbers and 0 not in numbers:  # counted from 1
        return {(landmark - 1, channel): at for (landmark, channel), at in found.items()}
    return {key: at for key, at in found.items() if key[0] < N_POINTS}


def _landmark_and_channel(title: str) -> tuple[int, int] | None:
    """Split a title such as `left_hip_x`, `landmark_23_z` or `y7`."""
    plain = SUFFIX.sub("", title)
    plain = PREFIX.sub("", plain, count=1) if PREFIX.match(plain) else plain
    if match := LETTER_FIRST.fullmatch(plain):
        return int(match[2]), CHANNELS[match[1]]
    if match := NAME_FIRST.fullmatch(plain):
        name = match[1]
        if name in BODY_POINTS:
            return BODY_POINTS.index(name), CHANNELS[match[2]]
        if name.isdigit() and len(name) <= 2:
            return int(name), CHANNELS[match[2]]
    return None
