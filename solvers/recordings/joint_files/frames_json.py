"""Read JSON of any pose estimator that lists the joints of people, frame by frame."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import JointRecording
from ...progress import Progress, Remark, unwatched
from ..containers import (
    JsonMember,
    describe_frame_files,
    json_content,
    json_frame_files,
    json_members,
)
from ..conventions import DEFAULT_FRAME_RATE, Bodies, check_scale
from .body_json import BodiesFrame, BodyJoints, name_of_body, open_frames, stacked
from .named_points import body_of_named_points
from .point_arrays import (
    body_of_points,
    read_body,
    second_of_times,
    stand_body,
    without_undetected,
)
from .unnamed_joints import has_layout

POINT_KEYS = (
    "keypoints3d", "keypoints_3d", "joints3d", "joints_3d", "joints3D", "pose_keypoints_3d",
    "pose3d", "pose_3d", "poses_3d", "positions", "joints", "keypoints", "xyz",
)  # fmt: skip
"""Members with the joints of a person."""
PEOPLE_KEYS = ("instances", "people", "persons", "bodies", "skeletons", "annots")
"""Members with the people of a frame."""
IDENTITY_KEYS = ("id", "track_id", "person_id", "body_id", "personID")
RATE_KEYS = ("fps", "frame_rate", "framerate", "frameRate")
TIME_KEYS = {"timestamp": None, "time": None, "timestamp_ms": 0.001, "time_ms": 0.001}
"""Seconds per unit of the time of a frame; None where the key does not state it."""
HEAD = re.compile(
    rb"\s*\[\s*\[\s*\[\s*[-\d]|\s*[\[{].*?\"("
    + "|".join(POINT_KEYS).encode()
    + rb')"\s*:\s*(\[\s*([\[{\d-]|null)|\{)',
    re.DOTALL,
)
MIN_JOINTS = 8
"""Number of joints of a person. It guards JSON of something else."""


class _Person(NamedTuple):
    identity: str
    names: tuple[str, ...]
    """Empty if the joints have none."""
    positions: Array
    """Shape (n_joints, 3)."""


class _Content(NamedTuple):
    """What a file, or the files of a take, hold."""

    frames: list[BodiesFrame]
    columns: dict[str, dict[str, int]]
    """Column of each named joint, by person."""
    rate: float | None
    second: float | None
    """Seconds per unit of the times; None if that is not stated."""

    @property
    def n_frames(self) -> int:
        """Number of frames of the person in most frames."""
        counts = Counter(body for frame in self.frames for body in frame.bodies)
        return max(counts.values(), default=0)


def is_frames_json(head: bytes) -> bool:
    """Return whether a file lists joints, from its first bytes."""
    return HEAD.match(head) is not None


def is_frame_json(path: Path | str) -> bool:
    """Return whether a file holds the joints of one frame."""
    listed = _read_content(json_members(path, lists=True), unwatched).n_frames
    outermost = _read_content([json_content(path)], unwatched).n_frames
    return listed <= 1 and max(listed, outermost) == 1


def open_frames_json(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[JointRecording]:
    """Open a list of frames with the joints of each person, in meters, Z up.

    A frame is an object with `keypoints`, `keypoints3d`, `joints`, `positions` or the like: a
    list of points, a list of numbers, or an object with a point for each name. It may list
    people in `instances`, `people` or the like, or be a list of points itself. Named joints may
    be missing in some frames. Joints without names are recognized by their bones
    (`name_joints`). Axes and unit are judged from the body. A file of one frame stands for all
    files of its take (`frame_files`).

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
    progress : Progress

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, has one frame of each person, or no people in 3D.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    content = own = _read_content(json_members(path, lists=True), progress)
    if own.n_frames <= 1:
        content = _read_content(json_frame_files(path), progress)
        if content.n_frames > 1:
            progress(0.8, Remark(describe_frame_files(len(content.frames))))
    if max(own.n_frames, content.n_frames) == 1:
        raise InvalidFileError(
            f"{path} holds the joints of one frame. Combine all frames in an array of the shape"
            " (frames, joints, 3), and save it with numpy.save."
        )
    frames, columns, rate, second = content
    if second is None:
        second = second_of_times(np.array([frame.time for frame in frames]), progress)

    def read(body: str, times: Array | None, progress: Progress) -> JointRecording:
        names = tuple(columns[body])
        return _recording(path, names, body, frames, times, rate, scale, progress)

    return open_frames(path, frames, second, read)


def _read_content(members: Iterable[JsonMember], progress: Progress) -> _Content:
    """Return the frames in the members of a file, or in the files of a take."""
    by_key: dict[str, list[BodiesFrame]] = {}
    columns: dict[str, dict[str, int]] = {}
    rate: float | None = None
    second: float | None = None
    for member in members:
        if member.key in RATE_KEYS and _is_number(member.value):
            rate = float(member.value)
        time = np.nan
        if isinstance(member.value, dict):
            key = next((key for key in TIME_KEYS if _is_number(member.value.get(key))), "")
            time, second = (float(member.value[key]), TIME_KEYS[key]) if key else (time, second)
        found = {}
        for person in _people(member.value):
            positions = _placed(person, columns.setdefault(person.identity, {}))
            unknown = np.full(len(positions), np.nan)
            found[person.identity] = BodyJoints(positions, unknown)
        by_key.setdefault(member.key, []).append(BodiesFrame(time, found, member.done))
        progress(0.8 * member.done, "Reading")
    return _Content(_frames(by_key), columns, rate, second)


def _frames(by_key: Mapping[str, list[BodiesFrame]]) -> list[BodiesFrame]:
    """Return the elements of the list that has people, or the members that have some."""
    longest = max(
        by_key.values(),
        key=lambda frames: sum(bool(each.bodies) for each in frames),
        default=[],
    )
    if len(longest) > 1:
        return longest
    return [each for frames in by_key.values() for each in frames if each.bodies]


def _placed(person: _Person, columns: dict[str, int]) -> Array:
    """Return the joints of a frame in the columns of their names; new names are added."""
    if not person.names:
        return person.positions
    for name in person.names:
        columns.setdefault(name, len(columns))
    positions = np.full((len(columns), 3), np.nan)
    positions[[columns[name] for name in person.names]] = person.positions
    return positions


def _widened(frame: BodiesFrame, body: str, n_joints: int) -> BodiesFrame:
    """Return a frame of one body with the joints that only later frames name."""
    if body not in frame.bodies:
        return frame._replace(bodies={})
    positions, confidence = frame.bodies[body]
    n_missing = n_joints - len(positions)
    if n_missing > 0:
        positions = np.pad(positions, ((0, n_missing), (0, 0)), constant_values=np.nan)
        confidence = np.pad(confidence, (0, n_missing), constant_values=np.nan)
    return frame._replace(bodies={body: BodyJoints(positions, confidence)})


def _recording(
    path: Path | str,
    names: tuple[str, ...],
    body: str,
    frames: list[BodiesFrame],
    times: Array | None,
    rate: float | None,
    scale: float | None,
    progress: Progress,
) -> JointRecording:
    try:
        points, _ = stacked(body, [_widened(frame, body, len(names)) for frame in frames])
    except ValueError:
        raise InvalidFileError(
            f"{path}: the number of joints of body {body} changes. Export it again."
        ) from None
    if not names:
        unnamed = body_of_points(path, points)
        if unnamed is None:
            raise InvalidFileError(
                f"{path} has {points.shape[1]} points without names, which form no body in a"
                " known order. Store the joints as a joint CSV, which has names."
            )
        return read_body(path, unnamed, scale, progress, times, rate)
    found = body_of_named_points(names, points)
    if found is None:
        raise InvalidFileError(
            f"{path} has joints called {', '.join(names[:3])} ..., which are no body. Store"
            " them as a joint CSV."
        )
    if times is None and rate is None:
        progress(0.8, Remark(f"The file has no times; {DEFAULT_FRAME_RATE:g} Hz is assumed"))
    return stand_body(
        path,
        found.names,
        found.positions,
        times=times,
        rate=rate or DEFAULT_FRAME_RATE,
        scale=scale,
        progress=progress,
    )


def _people(frame: Any) -> Iterator[_Person]:
    """Yield the people of a frame."""
    if isinstance(frame, list):
        points = _points(frame)
        if points is not None:
            yield _Person("0", (), points)
            return
        listed = frame
    elif isinstance(frame, dict):
        key = next((key for key in PEOPLE_KEYS if isinstance(frame.get(key), list)), "")
        listed = frame[key] if key else [frame]
    else:
        return
    for count, body in enumerate(listed):
        if isinstance(body, Mapping):
            yield from _person(body, count)


def _person(body: Mapping[str, Any], count: int) -> Iterator[_Person]:
    key = next((key for key in POINT_KEYS if body.get(key)), "")
    joints: Any = body.get(key)
    identity = name_of_body(body, IDENTITY_KEYS, count)
    is_named = isinstance(joints, Mapping)
    values = [_coordinates(joint) for joint in joints.values()] if is_named else joints
    points = _points(values) if isinstance(values, list) else None
    if points is not None:
        yield _Person(identity, tuple(map(str, joints)) if is_named else (), points)


def _coordinates(joint: Any) -> Any:
    """Return x, y and z of an object, or what stands in its place."""
    if joint is None:
        return [None] * 3
    if isinstance(joint, Mapping):
        inner = joint.get("position", joint)
        if isinstance(inner, Mapping):
            lower = {str(key).lower(): value for key, value in inner.items()}
            return [lower.get(axis) for axis in "xyz"]
        return inner
    return joint


def _points(values: list[Any]) -> Array | None:
    """Return nested or flat numbers as points, shape (n_points, 3); None for other values."""
    try:
        array = np.array(values, dtype=np.float64)
    except (ValueError, TypeError, OverflowError):
        return None
    if array.ndim == 1 and len(array) >= 3 * MIN_JOINTS:
        widths = [width for width in (3, 4) if len(array) % width == 0]
        known = [width for width in widths if has_layout(len(array) // width)]
        array = array.reshape(-1, (known or widths)[0]) if widths else array
    if array.ndim != 2 or array.shape[1] not in {3, 4} or len(array) < MIN_JOINTS:
        return None
    return array if array.shape[1] == 3 else without_undetected(array)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
