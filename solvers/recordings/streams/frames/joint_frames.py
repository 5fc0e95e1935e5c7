"""Encode and decode frames of a live stream: see docs/formats/joints/live_joints.md."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from ....errors import InvalidMotionError
from ....json_text import parse_json
from ....motion import JointRecording, Sensor
from ...conventions import MAX_TIME_S

FORMAT = "mocap-assist-live"
VERSION = 1
PORT = 46464
"""Default UDP port on the loopback address."""
MAX_LINE_BYTES = 32_768
"""Maximum size of a frame in bytes; a frame of 32 joints takes about 2,000."""
MAX_JOINTS = 64
MAX_LISTS = 4 * MAX_JOINTS
"""Maximum number of lists and objects in a line; each joint needs one. More cost time, mainly
in the garbage collector."""
MAX_NAME_LENGTH = 64
MAX_POSITION_M = 100.0
"""Maximum distance from the sensor on each axis, meters. It guards against damaged packets."""
MAX_BODY = 2**53
NUMBERS = (int, float)


@dataclass(frozen=True, eq=False)
class LiveFrame:
    """One body at one time.

    Attributes
    ----------
    time : float, seconds, of the sender's clock
    body : int
        Identifies the body among those that are tracked.
    names : tuple of str
    positions : shape (n_joints, 3), meters, Z up; NaN: not tracked
    confidence : shape (n_joints,), 0 to 1
    states : shape (n_joints,) of 2 tracked, 1 inferred, 0 not tracked; or None
    sensor : Sensor
    """

    time: float
    body: int
    names: tuple[str, ...]
    positions: NDArray[np.float64]
    confidence: NDArray[np.float64]
    states: NDArray[np.int8] | None = None
    sensor: Sensor = Sensor.OTHER


def encode_frame(frame: LiveFrame) -> bytes:
    """Return the frame as a line of JSON, rounded to 0.1 mm, with a line end."""
    observed = np.isfinite(frame.positions).all(axis=-1)
    fields: dict[str, Any] = {
        "format": FORMAT,
        "version": VERSION,
        "time": round(frame.time, 6),
        "body": frame.body,
        "sensor": frame.sensor.value,
        "names": frame.names,
        "positions": [
            position if is_observed else None
            for position, is_observed in zip(
                frame.positions.round(4).tolist(), observed, strict=True
            )
        ],
        "confidence": frame.confidence.round(4).tolist(),
    }
    if frame.states is not None:
        fields["states"] = frame.states.tolist()
    return json.dumps(fields, separators=(",", ":"), allow_nan=False).encode() + b"\n"


def decode_frame(line: bytes) -> LiveFrame:
    """Parse a frame from a line of JSON.

    Raises
    ------
    InvalidMotionError
        The line is too long, not JSON, of another format, or has an invalid value.
    """
    if len(line) > MAX_LINE_BYTES:
        raise InvalidMotionError(f"A frame of {len(line)} bytes is too long.")
    if line.count(b"[") + line.count(b"{") > MAX_LISTS:
        raise InvalidMotionError(f"A frame has more than {MAX_LISTS} lists.")
    try:
        fields = parse_json(line, parse_constant=_refuse)
    except ValueError:
        raise InvalidMotionError("A frame is not readable as JSON.") from None
    if not isinstance(fields, dict) or fields.get("format") != FORMAT:
        raise InvalidMotionError(f"A frame does not have the format {FORMAT}.")
    if fields.get("version") != VERSION:
        raise InvalidMotionError(f"A frame is not of version {VERSION} of the format.")
    names = _names(fields.get("names"))
    positions = _positions(fields.get("positions"), len(names))
    states = _states(fields.get("states"), len(names))
    confidence = _confidence(fields.get("confidence"), states, len(names))
    observed = np.isfinite(positions).all(axis=-1)
    return LiveFrame(
        _number(fields.get("time"), "time", MAX_TIME_S),
        _body(fields.get("body", 0)),
        names,
        positions,
        np.where(observed, confidence, 0.0),
        None if states is None else np.where(observed, states, 0).astype(np.int8),
        _sensor(fields.get("sensor", Sensor.OTHER.value)),
    )


def frames_from_recording(recording: JointRecording, body: int = 0) -> Iterator[LiveFrame]:
    """Yield the frames of a recording as a tracker would send them, starting at time 0."""
    tracks = recording.tracks
    states, confidence = recording.tracking_state, tracks.confidence
    for frame, positions in enumerate(tracks.positions):
        state = None if states is None else states[frame]
        values = (
            _confidence(None, state, len(tracks.names))
            if confidence is None
            else confidence[frame]
        )
        observed = np.isfinite(positions).all(axis=-1)
        yield LiveFrame(
            frame * tracks.dt,
            body,
            tracks.names,
            positions,
            np.where(observed, values, 0.0),
            state,
            recording.sensor,
        )


def _refuse(word: str) -> NoReturn:
    """Refuse NaN and Infinity, which are not JSON."""
    raise ValueError(word)


def _number(value: Any, name: str, limit: float) -> float:
    if type(value) not in NUMBERS or not -limit <= value <= limit:
        raise InvalidMotionError(f"A frame's {name} is not a number up to {limit:g}.")
    return float(value)


def _body(value: Any) -> int:
    if type(value) is not int or not 0 <= value <= MAX_BODY:
        raise InvalidMotionError("A frame's body is not an integer of at least 0.")
    return int(value)


def _sensor(value: Any) -> Sensor:
    sensors = {sensor.value: sensor for sensor in Sensor}
    if not isinstance(value, str) or value not in sensors:
        raise InvalidMotionError(f"A frame's sensor is not one of {', '.join(sensors)}.")
    return sensors[value]


def _names(value: Any) -> tuple[str, ...]:
    is_valid_list = isinstance(value, list) and 0 < len(value) <= MAX_JOINTS
    if not is_valid_list or not all(map(_is_name, value)) or len(set(value)) < len(value):
        raise InvalidMotionError(
            f"A frame's names are not 1 to {MAX_JOINTS} different words of at most"
            f" {MAX_NAME_LENGTH} letters."
        )
    return tuple(value)


def _is_name(value: Any) -> bool:
    return isinstance(value, str) and 0 < len(value) <= MAX_NAME_LENGTH and value.isprintable()


def _check_list(value: Any, name: str, length: int) -> list[Any]:
    if not isinstance(value, list) or len(value) != length:
        raise InvalidMotionError(f"A frame's {name} are not one for each of {length} names.")
    return value


def _positions(value: Any, n_joints: int) -> NDArray[np.float64]:
    positions = np.full((n_joints, 3), np.nan)
    for joint, position in enumerate(_check_list(value, "positions", n_joints)):
        if position is not None:
            coordinates = _check_list(position, "coordinates", 3)
            positions[joint] = [_number(one, "position", MAX_POSITION_M) for one in coordinates]
    return positions


def _states(value: Any, n_joints: int) -> NDArray[np.int8] | None:
    if value is None:
        return None
    states = _check_list(value, "states", n_joints)
    if not all(type(state) is int and 0 <= state <= 2 for state in states):
        raise InvalidMotionError("A frame's states are not 2, 1 or 0.")
    return np.array(states, dtype=np.int8)


def _confidence(
    value: Any, states: NDArray[np.int8] | None, n_joints: int
) -> NDArray[np.float64]:
    """Return the confidence of the frame; without it half of the tracking state, or 1."""
    if value is None:
        return np.ones(n_joints) if states is None else states / 2.0
    values = [
        _number(one, "confidence", 1.0) for one in _check_list(value, "confidences", n_joints)
    ]
    if min(values) < 0.0:
        raise InvalidMotionError("A frame's confidence is below 0.")
    return np.array(values)
