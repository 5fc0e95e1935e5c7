"""One frame of a live stream of joints as a line of JSON: see docs/formats/live_joints.md."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...json_text import parse_json
from ...motion import JointRecording, Sensor

FORMAT = "mocap-assist-live"
VERSION = 1
PORT = 46464
"""Of UDP on the machine's own address, where nobody names another."""
MAX_LINE_BYTES = 32_768
"""Bytes; a frame of 32 joints takes about 2,000."""
MAX_JOINTS = 64
MAX_LISTS = 4 * MAX_JOINTS
"""Lists and objects in a line; names are text, and each joint has one. More would only cost
time, of the garbage collector above all."""
MAX_NAME_LENGTH = 64
MAX_POSITION_M = 100.0
"""Metres from the sensor, on each axis; it sees no farther."""
MAX_TIME_S = 1e11
"""Seconds; thousands of years."""
MAX_BODY = 2**53
NUMBERS = (int, float)


@dataclass(frozen=True, eq=False)
class LiveFrame:
    """One body at one moment.

    Attributes
    ----------
    time : float, seconds, of the sender's clock
    body : int
        Which of the bodies that the tracker sees.
    names : tuple of str
    positions : shape (n_joints, 3), metres, Z up; NaN: not tracked
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
    """Return the frame as a line of JSON, with the tenth of a millimetre and a line's end."""
    seen = np.isfinite(frame.positions).all(axis=-1)
    said: dict[str, Any] = {
        "format": FORMAT,
        "version": VERSION,
        "time": round(frame.time, 6),
        "body": frame.body,
        "sensor": frame.sensor.value,
        "names": frame.names,
        "positions": [
            place if known else None
            for place, known in zip(frame.positions.round(4).tolist(), seen, strict=True)
        ],
        "confidence": frame.confidence.round(4).tolist(),
    }
    if frame.states is not None:
        said["states"] = frame.states.tolist()
    return json.dumps(said, separators=(",", ":"), allow_nan=False).encode() + b"\n"


def decode_frame(line: bytes) -> LiveFrame:
    """Return the frame that a line of JSON tells.

    Raises
    ------
    InvalidMotionError
        The line is too long, no JSON, of another format, or any value in it is not what
        belongs there. One sentence says what.
    """
    if len(line) > MAX_LINE_BYTES:
        raise InvalidMotionError(f"A frame of {len(line)} bytes is too long.")
    if line.count(b"[") + line.count(b"{") > MAX_LISTS:
        raise InvalidMotionError(f"A frame has more than {MAX_LISTS} lists.")
    try:
        said = parse_json(line, parse_constant=_refuse)
    except ValueError:
        raise InvalidMotionError("A frame is not readable as JSON.") from None
    if not isinstance(said, dict) or said.get("format") != FORMAT:
        raise InvalidMotionError(f"A frame does not say that its format is {FORMAT}.")
    if said.get("version") != VERSION:
        raise InvalidMotionError(f"A frame is not of version {VERSION} of the format.")
    names = _names(said.get("names"))
    positions = _positions(said.get("positions"), len(names))
    states = _states(said.get("states"), len(names))
    confidence = _confidence(said.get("confidence"), states, len(names))
    seen = np.isfinite(positions).all(axis=-1)
    return LiveFrame(
        _number(said.get("time"), "time", MAX_TIME_S),
        _body(said.get("body", 0)),
        names,
        positions,
        np.where(seen, confidence, 0.0),
        None if states is None else np.where(seen, states, 0).astype(np.int8),
        _sensor(said.get("sensor", Sensor.OTHER.value)),
    )


def frames_from_recording(recording: JointRecording, body: int = 0) -> Iterator[LiveFrame]:
    """Yield the frames of a recording as a tracker would have sent them, from second 0 on."""
    tracks = recording.tracks
    states, sure = recording.tracking_state, tracks.confidence
    for frame, positions in enumerate(tracks.positions):
        known = None if states is None else states[frame]
        told = _confidence(None, known, len(tracks.names)) if sure is None else sure[frame]
        seen = np.isfinite(positions).all(axis=-1)
        yield LiveFrame(
            frame * tracks.dt,
            body,
            tracks.names,
            positions,
            np.where(seen, told, 0.0),
            known,
            recording.sensor,
        )


def _refuse(word: str) -> NoReturn:
    """Refuse NaN and Infinity, which are no JSON."""
    raise ValueError(word)


def _number(value: Any, name: str, largest: float) -> float:
    if type(value) not in NUMBERS or not -largest <= value <= largest:
        raise InvalidMotionError(f"A frame's {name} is not a number up to {largest:g}.")
    return float(value)


def _body(value: Any) -> int:
    if type(value) is not int or not 0 <= value <= MAX_BODY:
        raise InvalidMotionError("A frame's body is not a whole number from 0 on.")
    return int(value)


def _sensor(value: Any) -> Sensor:
    known = {sensor.value: sensor for sensor in Sensor}
    if not isinstance(value, str) or value not in known:
        raise InvalidMotionError(f"A frame's sensor is none of {', '.join(known)}.")
    return known[value]


def _names(value: Any) -> tuple[str, ...]:
    fit = isinstance(value, list) and 0 < len(value) <= MAX_JOINTS
    if not fit or not all(map(_is_name, value)) or len(set(value)) < len(value):
        raise InvalidMotionError(
            f"A frame's names are not 1 to {MAX_JOINTS} words that differ, of at most"
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
    for joint, place in enumerate(_check_list(value, "positions", n_joints)):
        if place is not None:
            where = _check_list(place, "coordinates", 3)
            positions[joint] = [_number(one, "position", MAX_POSITION_M) for one in where]
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
    """Return what the frame says or, where it does not, half of the tracking state, or 1."""
    if value is None:
        return np.ones(n_joints) if states is None else states / 2.0
    told = [
        _number(one, "confidence", 1.0) for one in _check_list(value, "confidences", n_joints)
    ]
    if min(told) < 0.0:
        raise InvalidMotionError("A frame's confidence is below 0.")
    return np.array(told)
