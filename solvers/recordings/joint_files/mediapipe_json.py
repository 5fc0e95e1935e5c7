"""Read MediaPipe's world landmarks as programs save them: JSON."""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import JointRecording
from ...progress import Progress, Remark, unwatched
from ..containers import (
    JsonMember,
    array_from_json,
    describe_frame_files,
    json_content,
    json_frame_files,
    json_members,
)
from ..conventions import check_scale
from ..point_bodies import N_POINTS, recording_from_landmarks, seconds
from .body_json import number

WORLD = ("worldLandmarks", "pose_world_landmarks", "poseWorldLandmarks", "world_landmarks",
         "keypoints3D")  # fmt: skip
FLAT = ("landmarks", "pose_landmarks", "poseLandmarks", "landmark")
WRAPPERS = ("pose", "result", "results", "data")
KEYS = frozenset((*WORLD, *FLAT, *WRAPPERS))
"""Members of a frame, with or without a body."""
HEAD = re.compile(
    rb'\s*[\[{].*"(' + "|".join((*WORLD, *FLAT)).encode() + rb')"\s*:\s*[\[{]', re.DOTALL
)
TIMES = {
    "timestampMs": 1e-3, "timestamp_ms": 1e-3, "offsetMs": 1e-3, "time_ms": 1e-3,
    "timestamp": 1.0, "time": 1.0, "ptsSeconds": 1.0, "time_s": 1.0, "seconds": 1.0,
}  # fmt: skip
"""Seconds per unit of a time stamp, by its name."""
RATES = ("fps", "frame_rate", "frameRate", "FPS")
VISIBILITY = ("visibility", "presence", "score")


class _MediapipeContent(NamedTuple):
    """Content of a file, or of the files of a take."""

    frames: list[Array]
    """Landmarks of each frame, shape (33, 4)."""
    times: list[float]
    """Seconds; NaN without a time stamp."""
    rate: float | None


def is_mediapipe_json(head: bytes) -> bool:
    """Return whether the first bytes are JSON with landmarks."""
    return HEAD.match(head) is not None


def is_frame_mediapipe(path: Path | str) -> bool:
    """Return whether a file holds the landmarks of one frame."""
    listed = _read_content(path, json_members(path, lists=True), unwatched).frames
    outermost = _read_content(path, [json_content(path)], unwatched).frames
    return len(listed) <= 1 and max(len(listed), len(outermost)) == 1


def read_mediapipe_json(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> JointRecording:
    """Read world landmarks of MediaPipe, in meters, Z up, with visibility as confidence.

    MediaPipe has no file format; programs write its results in similar ways. Read are frames in
    a list, as the outermost value, or in a file each (`frame_files`), with 33 `worldLandmarks`
    (or `pose_world_landmarks`): objects with x, y, z and visibility, or lists. Of several
    bodies the first one is read. Landmarks of the picture are refused. The hips are always at
    the origin. Joints in the middle of the body are added (`COMPUTED_JOINTS`).

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
    content = _read_content(path, json_members(path, lists=True), progress)
    if len(content.frames) <= 1:
        content = _read_content(path, json_frame_files(path), progress)
        if len(content.frames) > 1:
            progress(0.9, Remark(describe_frame_files(len(content.frames))))
    frames, times, rate = content
    if not frames:
        raise InvalidFileError(f"{path} has no frames with landmarks. Export it again.")
    stamps = np.array(times)
    usable = np.isfinite(stamps).sum() > 1
    return recording_from_landmarks(
        path,
        np.stack(frames),
        seconds(stamps) if usable else None,
        rate if rate is not None and 0.0 < rate < np.inf else None,
        scale,
        progress,
    )


def _read_content(
    path: Path | str, members: Iterable[JsonMember], progress: Progress
) -> _MediapipeContent:
    """Return landmarks and time of each frame, and the rate, of a file or the files of a take.

    A file without a body is a frame without one.
    """
    frames: list[Array] = []
    times: list[float] = []
    rate: float | None = None
    n_several = 0
    for member in members:
        location = f"{path}, frame {len(frames) + 1}"
        if member.key in RATES:
            rate = number(member.value, f"{path}, {member.key}")
        elif member.value is None and not member.key:
            frames.append(np.full((N_POINTS, 4), np.nan))
            times.append(np.nan)
        elif isinstance(member.value, Mapping) or member.key in WORLD:
            found = frame_landmarks(member.value, location)
            n_several += sum(map(bool, _bodies_of(member.value))) > 1
            time = frame_time(member.value, location)
            if found is None and np.isnan(time) and KEYS.isdisjoint(member.value):
                continue  # something else, such as a header
            frames.append(np.full((N_POINTS, 4), np.nan) if found is None else found)
            times.append(time)
            progress(0.9 * member.done, "Reading")
    if n_several:
        progress(
            0.9,
            Remark(
                f"{n_several} frames have more than one person; the first of each is read, who"
                " may change. Use a tracker that identifies people"
            ),
        )
    return _MediapipeContent(frames, times, rate)


def frame_time(frame: Any, location: str) -> float:
    """Return the time stamp of a frame in seconds; NaN without one."""
    if not isinstance(frame, Mapping):
        return np.nan
    for key, unit in TIMES.items():
        if key in frame:
            return unit * number(frame[key], f"{location}, {key}")
    return np.nan


def frame_landmarks(frame: Any, location: str) -> Array | None:
    """Return x, y, z and visibility of the first body, shape (33, 4); None without one."""
    found = next(iter(_bodies_of(frame)), None)
    if not found:
        return None
    if not isinstance(found, list) or len(found) != N_POINTS:
        count = len(found) if isinstance(found, list) else 0
        raise InvalidFileError(
            f"{location} has {count} landmarks; those of MediaPipe's pose are {N_POINTS}. Save"
            " all of them."
        )
    return np.stack([_point(point, location) for point in found])


def _bodies_of(frame: Any) -> list[Any]:
    """Return the landmarks of each body of a frame, as they are in the file."""
    found = frame
    if isinstance(frame, Mapping):
        inner: Mapping[str, Any] = next(
            (frame[key] for key in WRAPPERS if isinstance(frame.get(key), Mapping)), {}
        )
        found = next(
            (each[key] for key in (*WORLD, *FLAT) for each in (frame, inner) if each.get(key)),
            None,
        )
    if isinstance(found, Mapping):
        found = next((found[key] for key in FLAT if key in found), found)
    if isinstance(found, list) and len(found) and isinstance(found[0], list):
        deep = found[0] and isinstance(found[0][0], list | Mapping)
        return found if deep else [found]
    return [found] if found else []


def _point(point: Any, location: str) -> Array:
    if isinstance(point, Mapping):
        confidence = next((point[key] for key in VISIBILITY if key in point), None)
        values = [*(point.get(axis) for axis in "xyz"), confidence]
    elif isinstance(point, list) and len(point) in {3, 4}:
        values = [*point, None][:4]
    else:
        values = []
    return array_from_json(values, (4,), f"{location}, landmark")
