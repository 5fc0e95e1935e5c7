"""Read skeletons of Nuitrack: the CSV of its recorder, and JSON of its interface."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import JointRecording, Sensor
from ...motion.skeletons import NUITRACK
from ...progress import Progress, unwatched
from ..containers import LineReader, decode_text, find_separator, split_cells, stream_cells
from ..conventions import (
    DEFAULT_FRAME_RATE,
    MILLIMETER,
    Bodies,
    JointSamples,
    check_scale,
    joint_recording,
    observed_body,
    recorded_seconds,
)
from ..identities import follow_bodies
from .json_bodies import (
    BodiesFrame,
    BodyJoints,
    checked_objects,
    json_frames,
    name_of_body,
    number,
    open_frames,
    point,
    stack_body,
)

CSV_HEAD = re.compile(rb"(?i)[^\r\n]*\bJOINT_WAIST\.x\b")
JSON_HEAD = re.compile(
    rb'(?is)\s*[\[{].*"(skeletons|users|skeleton)"\s*:\s*\['
    rb'.*"(joints"\s*:\s*\[|joints"\s*:|(head|torso|JOINT_\w+)"\s*:)\s*\{'
)
OWN_JOINTS = re.compile(
    rb'(?i)"(joint_(?!names?")\w+|torso|waist|left_?collar)"'
    rb'|"type"\s*:\s*"?(\d|joint_|head|neck|torso|waist)'
)
"""What other programs with `skeletons` and `joints` lack: its joints, or their type."""
KEYS = frozenset({"skeletons", "Skeletons", "users", "Users", "skeleton", "Skeleton"})
IDS = ("user_id", "userId", "id", "ID", "Id")
TIMES = ("timestamp", "Timestamp", "TimeStamp", "time")
POSITIONS = ("real", "Real", "position", "Position")
MICROSECOND = 1e-6
COLLARS = ("ClavicleLeft", "ClavicleRight")
CHEST = "SpineChest"


def is_nuitrack_csv(head: bytes) -> bool:
    """Return whether the first line names the joints of Nuitrack."""
    return CSV_HEAD.match(head) is not None


def is_nuitrack_json(head: bytes) -> bool:
    """Return whether the first bytes are skeletons with Nuitrack's joints."""
    return JSON_HEAD.match(head) is not None and OWN_JOINTS.search(head) is not None


def open_nuitrack_csv(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[JointRecording]:
    """Open the CSV of Nuitrack's recorder [1]_, in meters, Z up; missing joints are NaN.

    Frames are resampled to a constant rate by their time stamps; repeated stamps are skipped.
    Both collars are one point, which becomes the joint between the shoulders. Joints are called
    as those of the Azure Kinect.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: meters, unless these do not give a human body.
    progress : Progress

    Raises
    ------
    InvalidFileError
        The file is missing, damaged or has no user.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] 3DiVi, nuitrack-sdk, doc/CSV_Recorder.md.
    """
    check_scale(scale)
    reader = LineReader(path)
    reader.skip_blank_lines()
    heading = b"".join(reader.take())
    separator = find_separator(heading)
    titles = [decode_text(cell).upper() for cell in split_cells(heading, separator)]
    serial = {titles.index("SERIAL"): lambda cell: b""} if "SERIAL" in titles else {}
    rows = stream_cells(reader, separator, len(titles), path, progress, converters=serial)
    columns = {
        name: [titles.index(f"JOINT_{joint}.{axis}") for axis in "XYZ"]
        for joint, name in NUITRACK.items()
        if {f"JOINT_{joint}.{axis}" for axis in "XYZ"} <= set(titles)
    }
    if not columns or not len(rows):
        raise InvalidFileError(f"{path} has no joints, only a header. Export it again.")
    users = rows[:, titles.index("ID")] if "ID" in titles else np.zeros(len(rows))
    known = np.unique(users[np.isfinite(users)])
    if not len(known):
        raise InvalidFileError(f"{path} has no user in any frame. Export it again.")
    times = MICROSECOND * rows[:, titles.index("TIMESTAMP")] if "TIMESTAMP" in titles else None
    instants = np.arange(len(rows)) if times is None else times
    n_frames = len(np.unique(instants))
    points = rows[:, list(columns.values())]
    users = _followed_users(users, instants, points, times is not None, progress)
    duration = n_frames / DEFAULT_FRAME_RATE if times is None else recorded_seconds(times)
    people = tuple(
        observed_body(
            f"{user:g}",
            np.searchsorted(np.unique(instants), instants[users == user]),
            n_frames,
            duration,
        )
        for user in known
    )

    def read(index: int, progress: Progress) -> JointRecording:
        mine = users == known[index]
        positions = rows[mine][:, list(columns.values())]
        stamps = None if times is None else times[mine]
        return _recording(path, list(columns), positions, None, stamps, scale, 1.0, progress)

    return Bodies(str(path), people, read)


def _followed_users(
    users: Array,
    instants: NDArray[np.generic],
    points: Array,
    has_times: bool,
    progress: Progress,
) -> Array:
    """Return the user of each row, those that the tracker swapped swapped back.

    Parameters
    ----------
    users, instants : shape (n_rows,)
    points : shape (n_rows, n_joints, 3)
    has_times : whether instants are seconds, rather than numbers of frames
    progress : Progress
    """
    stamps, frames = np.unique(np.asarray(instants, np.float64), return_inverse=True)
    found: list[dict[str, int]] = [{} for _ in stamps]
    for row in np.flatnonzero(np.isfinite(users)).tolist():
        found[frames[row]].setdefault(f"{users[row]:.17g}", row)
    times = stamps if has_times else None
    users = users.copy()
    for frame in follow_bodies(found, lambda row: points[row], times, progress):
        for user, row in frame.items():
            users[row] = float(user)
    return users


def open_nuitrack_json(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[JointRecording]:
    """Open skeletons that a program of Nuitrack's interface saved as JSON.

    Nuitrack has no file format of its own but the CSV. Read are frames with `skeletons` (or
    `users`), each with an id and `joints`: a list of objects with `type`, by number or name,
    or objects by name; in both `real` (millimeters) and `confidence`, as in its interface.

    Parameters, results and errors are those of `open_nuitrack_csv`; without `scale` lengths
    are millimeters, unless these do not give a human body.
    """
    check_scale(scale)
    frames: list[BodiesFrame] = []
    for _, value, done in json_frames(path, KEYS):
        frames.append(_read_frame(value, done, f"{path}, frame {len(frames) + 1}"))
        progress(done, "Reading")

    def read(
        frames: list[BodiesFrame], body: str, times: Array | None, progress: Progress
    ) -> JointRecording:
        positions, confidence = stack_body(body, frames)
        names = list(NUITRACK.values())
        return _recording(
            path, names, positions, confidence, times, scale, MILLIMETER, progress
        )

    return open_frames(path, frames, MICROSECOND, read, progress)


def _read_frame(value: Mapping[str, Any], done: float, location: str) -> BodiesFrame:
    bodies: dict[str, BodyJoints] = {}
    for count, body in enumerate(checked_objects(_first(value, tuple(KEYS)), location)):
        joints = _first(body, ("joints", "Joints"))
        found = _read_joints(body if joints is None else joints, location)
        bodies.setdefault(name_of_body(body, IDS, count), found)
    return BodiesFrame(number(_first(value, TIMES), f"{location}, timestamp"), bodies, done)


def _read_joints(joints: Any, location: str) -> BodyJoints:
    """Return all joints of `NUITRACK`; NaN where the file has none."""
    positions, confidence = np.full((len(NUITRACK), 3), np.nan), np.full(len(NUITRACK), np.nan)
    named = joints.items() if isinstance(joints, Mapping) else enumerate(joints or ())
    for key, joint in named:
        if not isinstance(joint, Mapping):
            continue
        index = _index(_first(joint, ("type", "Type", "name")), key)
        position = _first(joint, POSITIONS)
        if index < 0 or position is None:
            continue
        positions[index] = point(position, location)
        known = _first(joint, ("confidence", "Confidence"))
        confidence[index] = number(known, f"{location}, confidence")
        if confidence[index] == 0.0:
            positions[index] = np.nan
    return BodyJoints(positions, confidence)


def _index(type_: Any, key: Any) -> int:
    """Return the index in `NUITRACK` of a joint by its type, or by its key; -1 if unknown."""
    if isinstance(type_, int) and 0 < type_ <= len(NUITRACK):
        return type_ - 1
    name = str(key if type_ is None else type_).upper().removeprefix("JOINT_")
    return list(NUITRACK).index(name) if name in NUITRACK else -1


def _first(value: Mapping[str, Any], keys: tuple[str, ...]) -> Any:
    return next((value[key] for key in keys if key in value), None)


def _recording(
    path: Path | str,
    names: list[str],
    positions: Array,
    confidence: Array | None,
    times: Array | None,
    scale: float | None,
    unit: float,
    progress: Progress,
) -> JointRecording:
    """Build the recording: x to the camera's right, y up, z forward become ours."""
    x, y, z = np.moveaxis(positions, -1, 0)
    positions = np.stack([x, z, y], axis=-1)
    names = list(names)
    if names.count(COLLARS[0]) and names.count(COLLARS[1]):
        left, right = (names.index(name) for name in COLLARS)
        positions[:, left] = positions[:, [left, right]].mean(axis=1)
        kept = [index for index in range(len(names)) if index != right]
        names[left] = CHEST
        names, positions = [names[index] for index in kept], positions[:, kept]
        confidence = None if confidence is None else confidence[:, kept]
    return joint_recording(
        path,
        JointSamples(names, positions, Sensor.NUITRACK, confidence=confidence, times=times),
        scale=scale,
        default_unit=unit,
        progress=progress,
    )
