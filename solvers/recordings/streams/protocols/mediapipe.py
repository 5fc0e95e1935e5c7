"""Landmarks of MediaPipe, a frame of JSON in each line.

There is no standard. The decoder accepts what the reader of files does: 33 world landmarks of a
body.
"""

import json
from collections.abc import Iterator, Mapping
from typing import Any, NoReturn

import numpy as np

from ....arrays import Array
from ....errors import InvalidFileError, InvalidMotionError
from ....json_text import parse_json
from ....motion import Sensor
from ....motion.humanoid import SIDES
from ...conventions import MAX_TIME_S, MILLISECOND, from_azure_space
from ...joint_files import people_of_frame, time_of_frame
from ...point_bodies import (
    HIPS,
    LANDMARK_JOINTS,
    is_world,
    landmark_columns,
    with_computed_joints,
)
from ..frames import LiveFrame
from .axes import checked_positions

MAX_LINE_BYTES = 32_768
"""Maximum size of a line in bytes; 33 landmarks take about 4,000."""
MAX_LISTS = 1024
"""Maximum number of lists and objects in a line; landmarks of body, hands and face take 600. It
bounds the time of a line."""
DAMAGED = "A line with landmarks is damaged."
N_LANDMARKS = 33
MARKS = (b"andmark", b'"keypoints3D"')
"""What the keys of landmarks have in common."""
MAX_STEP_S = 2.0
"""Step between two frames in seconds from which stamps may be milliseconds. By definition that
of the reader of files."""
MAX_SPEED = 32.0
"""Step of the stamps, in steps of the arrival, from which stamps are milliseconds. By
definition the middle between 1 and 1,000, as ratios go."""
ROLE_OF_LANDMARK = {
    "shoulder": "UpperArm", "elbow": "LowerArm", "wrist": "Hand", "pinky": "Hand",
    "index": "Hand", "thumb": "Hand", "hip": "UpperLeg", "knee": "LowerLeg", "ankle": "Foot",
    "heel": "Foot", "foot_index": "Toes",
}  # fmt: skip
"""Humanoid role of the joint at or next to a landmark of a side; those of the face are next to
the head."""


def is_mediapipe(packet: bytes) -> bool:
    """Return whether a packet is of this protocol."""
    return any(mark in packet for mark in MARKS)


class MediaPipeDecoder:
    """Decodes lines of JSON."""

    max_parts = 128
    """Number of lines to read at a time: four seconds."""

    def __init__(self) -> None:
        self._last: tuple[float, float] | None = None
        self._unit: float | None = None

    def parts(self, datagram: bytes) -> list[bytes]:
        """Return the lines."""
        return datagram.splitlines()

    def decode(self, part: bytes, arrived: float) -> Iterator[LiveFrame]:
        """Yield the frame of a line; none if it has no body.

        Raises
        ------
        InvalidFileError, InvalidMotionError
            The line is damaged, has image landmarks, or an invalid value.
        """
        if len(part) > MAX_LINE_BYTES:
            raise InvalidMotionError(DAMAGED)
        if part.count(b"[") + part.count(b"{") > MAX_LISTS:
            raise InvalidMotionError(f"A frame has more than {MAX_LISTS} lists.")
        try:
            fields = parse_json(part, parse_constant=_refuse)
        except ValueError:
            raise InvalidMotionError(DAMAGED) from None
        landmarks = _landmarks_of(fields)
        if landmarks is None or not _shows_hips(landmarks):
            return
        points = landmarks[None, :, :3]
        if not is_world(points):
            raise InvalidFileError(
                "The stream has image landmarks, without true depth. Send MediaPipe's"
                " pose_world_landmarks."
            )
        visibility = np.nan_to_num(np.clip(landmarks[None, :, 3], 0.0, 1.0), nan=1.0)
        yield LiveFrame(
            self._seconds(_stamp_of(fields), arrived),
            0,
            LANDMARK_JOINTS,
            with_computed_joints(from_azure_space(checked_positions(points)))[0],
            with_computed_joints(visibility)[0],
            None,
            Sensor.MEDIAPIPE,
        )

    def _seconds(self, stamp: float, arrived: float) -> float:
        """Return a time stamp in seconds; that of arrival where there is none.

        The first step decides on the unit: a gap in a stream takes as long to arrive.
        """
        if not np.isfinite(stamp):
            return arrived
        last_stamp, last_arrived = self._last or (stamp, arrived)
        self._last = (stamp, arrived)
        step = stamp - last_stamp
        if self._unit is None and step > 0.0:
            is_long = step > max(MAX_STEP_S, MAX_SPEED * (arrived - last_arrived))
            self._unit = MILLISECOND if is_long else 1.0
        time = stamp if self._unit is None else self._unit * stamp
        if not abs(time) <= MAX_TIME_S:
            raise InvalidMotionError(f"A frame's time is not a number up to {MAX_TIME_S:g}.")
        return time


def _landmarks_of(fields: Any) -> Array | None:
    """Return x, y, z and visibility of the first person, shape (33, 4); None without one."""
    person = next(people_of_frame(fields), None)
    if person is None:
        return None
    columns = landmark_columns(person.points.names)
    if columns is None:
        raise InvalidMotionError(DAMAGED)
    return np.column_stack(person.points[:2])[columns]


def _stamp_of(fields: Any) -> float:
    """Return the time of a frame, in seconds if it states the unit; NaN if it has none."""
    time, second = time_of_frame(fields) if isinstance(fields, Mapping) else (np.nan, None)
    return time if second is None else time * second


def _shows_hips(landmarks: Array) -> bool:
    """Return whether the hips were seen: where they were not, all is NaN or zero."""
    hips = landmarks[HIPS, :3]
    return bool(np.isfinite(hips).all() and hips.any())


def encode_mediapipe(frame: LiveFrame, roles: Mapping[str, int]) -> bytes:
    """Return a line of JSON, whose landmarks are the joints, or those next to them.

    Parameters
    ----------
    frame : LiveFrame
    roles : mapping of humanoid roles to joints
        With both upper legs.
    """
    hips = [frame.positions[roles[f"{side}UpperLeg"]] for side in SIDES]
    center = np.mean(hips, axis=0)
    landmarks = []
    for name in LANDMARK_JOINTS[:N_LANDMARKS]:
        joint = roles.get(_role(name))
        point = np.full(3, np.nan) if joint is None else frame.positions[joint] - center
        is_visible = joint is not None and np.isfinite(point).all()
        x, y, z = np.nan_to_num(point).round(5).tolist()
        visibility = float(frame.confidence[joint]) if is_visible else 0.0
        landmarks.append({"x": x, "y": -z, "z": y, "visibility": round(visibility, 4)})
    fields = {"timestamp": round(frame.time, 6), "pose_world_landmarks": landmarks}
    return json.dumps(fields, separators=(",", ":"), allow_nan=False).encode() + b"\n"


def _role(landmark: str) -> str:
    side, _, part = landmark.partition("_")
    role = ROLE_OF_LANDMARK.get(part)
    return f"{side}{role}" if role else "head"


def _refuse(word: str) -> NoReturn:
    """Refuse NaN and Infinity, which are not JSON."""
    raise ValueError(word)
