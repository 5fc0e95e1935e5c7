"""Read MediaPipe's world landmarks as programs save them: CSV."""

import re
from pathlib import Path

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
    split_cells,
    stream_cells,
)
from ..conventions import check_scale
from ..point_bodies import N_POINTS, recording_from_landmarks, second_of_times, time_name

CHANNELS = {"x": 0, "y": 1, "z": 2, "v": 3, "vis": 3, "visibility": 3}
PREFIX = re.compile(r"((world|pose|landmarks?|lm|kp|point)(_|(?=\d)))+")
OF_WORLD = re.compile(r"(^|_)world(_|$)|3d$")
"""In the title of a column in the world."""
SUFFIX = re.compile(r"_(world|m|meters)$|_?3d$")
NAME_FIRST = re.compile(r"(.+?)_?([xyzv]|vis|visibility)")
LETTER_FIRST = re.compile(r"([xyzv]|vis|visibility)_?(\d{1,2})")
MIN_LANDMARKS = 17
"""Number of landmarks with a column x, from which a table is one of poses. By definition more
than half of the 33 of MediaPipe."""


def is_mediapipe_csv(head: bytes) -> bool:
    """Return whether the first line names the coordinates of the landmarks of a pose."""
    lines = head.lstrip().splitlines()
    titles = _titles(lines[0]) if lines else []
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

    A line is a frame, with columns such as `nose_x`, `landmark_0_x` or `x0`; for tables with a
    line for each landmark see `open_long_table`. Visibility becomes the confidence. Of columns
    in the picture and in the world (`world` in the title), the latter are read; landmarks of
    the picture alone are refused. Without a column of times, frames are taken to be 1 / 30 s
    apart.

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
    rows = stream_cells(reader, separator, len(titles), path, within(progress, 0.0, 0.9))
    if not len(rows):
        raise InvalidFileError(f"{path} has a header but no frames. Export it again.")
    points, times = _landmarks(titles, rows), _times(titles, rows, progress)
    return recording_from_landmarks(path, points, times, None, scale, progress)


def _landmarks(titles: list[str], rows: Array) -> Array:
    """Return x, y, z and visibility of each landmark, shape (n_frames, 33, 4)."""
    points = np.full((len(rows), N_POINTS, 4), np.nan)
    for (landmark, channel), column in _columns(titles).items():
        points[:, landmark, channel] = rows[:, column]
    if np.isnan(points[..., 2]).all():
        points[..., 2] = np.where(np.isfinite(points[..., 0]), 0.0, np.nan)  # a picture
    return points


def mediapipe_landmark(name: str) -> int | None:
    """Return the number of a landmark that is called by its name; None for others."""
    plain = re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_")
    return BODY_POINTS.index(plain) if plain in BODY_POINTS else None


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


def _columns(titles: list[str]) -> dict[tuple[int, int], int]:
    """Return columns by landmark and channel: those of the world, if there are any."""
    in_world = [at for at, title in enumerate(titles) if OF_WORLD.search(title)]
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
