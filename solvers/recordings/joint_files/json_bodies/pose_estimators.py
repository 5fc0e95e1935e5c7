"""Read JSON of any pose estimator that lists the joints of people, frame by frame."""

import re
from collections import Counter
from collections.abc import Iterable, Mapping
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ....arrays import Array
from ....errors import InvalidFileError
from ....files import open_regular
from ....motion import JointRecording
from ....progress import Progress, Remark, unwatched
from ...containers import (
    JsonMember,
    describe_frame_files,
    frame_files,
    json_content,
    json_frame_files,
    json_members,
)
from ...conventions import MAX_PEOPLE, Bodies, check_scale, rate_of_numbers
from ...point_bodies import (
    read_time,
    second_of_times,
    time_name,
)
from .bodies import BodiesFrame, BodyJoints, StatedRoot, open_frames
from .body_recording import in_columns, recording_of_body
from .joined_frames import (
    NumberedFrame,
    frozen_clocks,
    joined_frames,
    without_header,
)
from .keyed_frames import NUMBERS, ROOT, json_by_frame
from .people import LIST_OF_NAMES, JsonPerson, people_of_frame
from .points import MIN_JOINTS, transform_of
from .stamps import NUMBER_KEYS, StatedRate, is_number, stamps_of_frame, stated_rates

ROTATION = re.compile(rb"(?i)\"\w*(?:rot|quat|orient|euler)\w*\"\s*:\s*[\[{]")
"""Member with the rotation of a bone."""
MAX_HEAD_BYTES = 1 << 16
"""Bytes of a file in which rotations are looked for. It bounds the run time."""
_Row = tuple[str, dict[str, tuple[float, float | None]], NumberedFrame]
"""Key of a member, the times that it states by their keys, and its frame."""


class _Content(NamedTuple):
    """Content of a file, or of the files of a take."""

    frames: list[BodiesFrame]
    rate: float | None
    second: float | None
    """Seconds per unit of the times; None if that is not stated."""
    names: tuple[str, ...]
    """Names of the joints that a file lists apart from their positions."""

    @property
    def n_frames(self) -> int:
        """Number of frames of the person in most frames."""
        counts = Counter(body for frame in self.frames for body in frame.bodies)
        return max(counts.values(), default=0)


def is_frame_json(path: Path | str) -> bool:
    """Return whether a file holds the joints of one frame."""
    listed = _read_content(path, json_members(path, lists=True), unwatched).n_frames
    outermost = _read_content(path, [json_content(path)], unwatched).n_frames
    return _may_be_one_frame(listed, path) and (listed > 1 or max(listed, outermost) == 1)


def open_frames_json(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[JointRecording]:
    """Open a list of frames with the joints of each person, in meters, Z up.

    A frame is an object with `keypoints`, `keypoints3d`, `joints`, `positions` or the like: a
    list of points, a list of numbers, or an object with a point for each name. It may list
    people in `instances`, `people` or the like, or be a list of points itself. A file may also
    be keyed by frame or by joint (`json_by_frame`). Named joints may be missing in some frames.
    Joints without names are recognized by their bones (`name_joints`). Axes and unit are
    estimated from the body. A file of one frame stands for all files of its take
    (`frame_files`).

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
    content = own = _read_content(path, json_members(path, lists=True), progress)
    if _may_be_one_frame(own.n_frames, path):
        content = _read_content(path, json_frame_files(path), progress)
        if content.n_frames > 1:
            progress(0.8, Remark(describe_frame_files(len(content.frames))))
    if max(own.n_frames, content.n_frames) == 1:
        raise InvalidFileError(
            f"{path} holds the joints of one frame. Combine all frames in an array of the shape"
            " (frames, joints, 3), and save it with numpy.save."
        )
    frames, rate, second, listed_names = content
    if not any(frame.bodies for frame in frames):
        _refuse_rotations(path)
    if second is None:
        second = second_of_times(np.array([frame.time for frame in frames]), progress)

    def read(
        frames: list[BodiesFrame], body: str, times: Array | None, progress: Progress
    ) -> JointRecording:
        names, placed = in_columns(path, body, frames)
        return recording_of_body(
            path, names or listed_names, body, placed, times, rate, scale, progress
        )

    return open_frames(path, frames, second, read, progress)


def _refuse_rotations(path: Path | str) -> None:
    """Raise InvalidFileError if the members of bones are rotations."""
    with open_regular(path) as file:
        head = file.read(MAX_HEAD_BYTES)
    if sum(1 for _ in islice(ROTATION.finditer(head), MIN_JOINTS)) == MIN_JOINTS:
        raise InvalidFileError(
            f"{path} holds rotations of bones without their positions in the room. Export BVH,"
            " FBX or GLB, or the positions of joints."
        )


def _may_be_one_frame(n_listed: int, path: Path | str) -> bool:
    """Return whether a file with as many frames may be one of a take with a file for each.

    A list of few lists of points is the people of one frame if there are more such files.
    """
    if not 1 < n_listed <= MAX_PEOPLE:
        return n_listed <= 1
    value = json_content(path).value
    is_bare = isinstance(value, list) and all(isinstance(each, list) for each in value)
    return is_bare and len(frame_files(path).files) > n_listed


def _read_content(
    path: Path | str, members: Iterable[JsonMember], progress: Progress
) -> _Content:
    """Return the frames in the members of a file, or in the files of a take."""
    rows: list[_Row] = []
    stated: list[tuple[str, StatedRate]] = []
    second: float | None = None
    names: list[str] = []
    times: list[float] = []
    others: dict[str, Any] = {}
    n_several = 0
    for member in json_by_frame(without_header(members), path):
        value = member.value
        if member.key in LIST_OF_NAMES and isinstance(value, str):
            names.append(value)
        if not isinstance(value, dict) and (name := time_name(member.key)):
            time, second = read_time(value, name.second)
            times.append(time)
            continue
        if member.key in {ROOT, NUMBERS}:
            others[member.key] = value
            continue
        people = [*people_of_frame(value, member.key)]
        n_several += sum(not person.is_identified for person in people) > 1
        if not people:
            stated += ((member.key, rate) for rate in stated_rates({member.key: value}))
        rows.append(_row_of(member, people))
        progress(0.8 * member.done, "Reading")
    if n_several:
        progress(0.8, _remark_of_unidentified(n_several))
    by_key, second = _by_key(rows, second, progress)
    frames = _with_roots(
        _timed(joined_frames(by_key, path), times), _roots_of(others.get(ROOT, {}))
    )
    numbers = _numbers(rows) or others.get(NUMBERS, [])
    rate = _rate_of_frames(frames, numbers, _best_rate(rows, stated), progress)
    return _Content(frames, rate, second, tuple(names))


def _row_of(member: JsonMember, people: Iterable[JsonPerson]) -> _Row:
    """Return the key of a member, the times that it states, and its people as a frame."""
    value = member.value if isinstance(member.value, dict) else {}
    found = {each.identity: BodyJoints(*each.points, root=each.root) for each in people}
    frame = BodiesFrame(np.nan, found, member.done)
    return member.key, stamps_of_frame(value), NumberedFrame(_number_of(value), frame)


def _by_key(
    rows: list[_Row], second: float | None, progress: Progress
) -> tuple[dict[str, list[NumberedFrame]], float | None]:
    """Return frames by the keys of their members, with their times, and seconds per unit."""
    frozen = frozen_clocks(stamps for _, stamps, _ in rows)
    n_stated = Counter(key for _, stamps, _ in rows for key in stamps)
    if frozen and frozen == n_stated.keys() and max(n_stated.values()) > 1:
        progress(0.8, Remark("The times of the file stand still and are not used"))
    by_key: dict[str, list[NumberedFrame]] = {}
    for key, stamps, row in rows:
        moving = [stamp for clock, stamp in stamps.items() if clock not in frozen]
        time, second = moving[0] if moving else (np.nan, second)
        placed = row._replace(frame=row.frame._replace(time=time))
        by_key.setdefault(key, []).append(placed)
    return by_key, second


def _best_rate(rows: list[_Row], stated: list[tuple[str, StatedRate]]) -> float | None:
    """Return the rate that a file states; None without one.

    A member that occurs several times is a frame, whose rate is another one if it has a time.
    """
    n_members = Counter(key for key, _, _ in rows)
    frames = {
        key
        for key, stamps, row in rows
        if n_members[key] > 1 and (stamps or not np.isnan(row.number))
    }
    rates = sorted(rate for key, rate in stated if key not in frames)
    return rates[0].rate if rates else None


def _rate_of_frames(
    frames: list[BodiesFrame], numbers: list[float], rate: float | None, progress: Progress
) -> float | None:
    """Return the rate of frames by their numbers (`rate_of_numbers`), if none has a time."""
    if any(not np.isnan(frame.time) for frame in frames):
        return rate
    return rate_of_numbers(numbers, rate, progress)


def _numbers(rows: list[_Row]) -> list[float]:
    """Return the numbers that frames state, in order."""
    return sorted({row.number for _, _, row in rows if not np.isnan(row.number)})


def _remark_of_unidentified(n_several: int) -> Remark:
    return Remark(
        f"{n_several} frames have more than one person without an identity; they are"
        " followed by their positions. Check the frames with people close to each other"
    )


def _timed(frames: list[BodiesFrame], times: list[float]) -> list[BodiesFrame]:
    """Return frames with the times that are listed apart, if there is one for each."""
    if len(times) != len(frames) or not all(np.isnan(frame.time) for frame in frames):
        return frames
    return [frame._replace(time=time) for frame, time in zip(frames, times, strict=True)]


def _roots_of(values: Mapping[str, list[Any]]) -> list[StatedRoot | None]:
    """Return where the body is in each frame, by the key of its positions."""
    return [
        None if (transform := transform_of(position)) is None else StatedRoot(key, transform)
        for key, positions in values.items()
        for position in positions
    ]


def _with_roots(frames: list[BodiesFrame], roots: list[StatedRoot | None]) -> list[BodiesFrame]:
    """Return frames with the place of a person who is alone, if there is one for each."""
    if len(roots) != len(frames) or len({who for frame in frames for who in frame.bodies}) > 1:
        return frames
    return [
        frame._replace(
            bodies={who: joints._replace(root=root) for who, joints in frame.bodies.items()}
        )
        for frame, root in zip(frames, roots, strict=True)
    ]


def _number_of(frame: Mapping[str, Any]) -> float:
    """Return the number that a frame states; NaN if there is none."""
    values = (frame[key] for key in NUMBER_KEYS if is_number(frame.get(key)))
    return float(next(values, np.nan))
