"""Parse the header that our two joint formats share."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError, InvalidMotionError
from ...motion import FileConventions, JointRecording, Sensor
from ...progress import Progress
from ..containers import shown
from ..conventions import METERS, JointSamples, axes_of_points, joint_recording, points_z_up
from .kinect_csv import checked_states

FORMAT = "mocap-assist-joints"
VERSION = 1
UP = ("x", "y", "z", "-x", "-y", "-z")


@dataclass(frozen=True)
class JointHeader:
    """Interpretation of the numbers.

    Frame rate in hertz, or None if each frame has its time; meters per unit, or None if not
    stated; the up axis; the sensor.
    """

    frame_rate: float | None
    unit: float | None
    up: str
    sensor: Sensor

    @property
    def conventions(self) -> FileConventions:
        """Axes of the file."""
        return axes_of_points(self.up)


def parse_header(fields: Mapping[str, Any], location: str) -> JointHeader:
    """Parse a header; the message of an InvalidFileError begins with `location`."""
    if fields.get("format") != FORMAT or str(fields.get("version")) != str(VERSION):
        raise InvalidFileError(
            f"{location}: this Mocap Assist reads {FORMAT} {VERSION}, not"
            f" {shown(str(fields.get('format')))} {shown(str(fields.get('version')))}."
        )
    rate = fields.get("frame_rate")
    try:
        frame_rate = None if rate is None or rate == "" else float(str(rate))
    except ValueError:
        frame_rate = 0.0
    if frame_rate is not None and not 0.0 < frame_rate < float("inf"):
        raise InvalidFileError(
            f"{location}: a frame_rate of {shown(str(rate))} is not above 0; write hertz, or"
            " leave it out and give each frame its time."
        )
    unit = METERS[_choice(fields, "units", "m", tuple(METERS), location)]
    up = _choice(fields, "up", "z", UP, location)
    sensors = tuple(sensor.value for sensor in Sensor)
    sensor = _choice(fields, "sensor", Sensor.OTHER.value, sensors, location)
    return JointHeader(frame_rate, unit if "units" in fields else None, up, Sensor(sensor))


def _choice(
    fields: Mapping[str, Any], key: str, default: str, choices: tuple[str, ...], location: str
) -> str:
    value = str(fields.get(key, default)).strip().lower()
    if value not in choices:
        raise InvalidFileError(
            f"{location}: {key} is {shown(value)!r}; write one of {', '.join(choices)}."
        )
    return value


def build_recording(
    path: Path | str,
    names: Sequence[str],
    header: JointHeader,
    positions: NDArray[np.float64],
    *,
    states: NDArray[np.float64] | None,
    confidence: NDArray[np.float64] | None,
    times: NDArray[np.float64] | None,
    scale: float | None,
    progress: Progress,
) -> JointRecording:
    """Build a recording as `joint_recording` does, from a header; a missing state becomes 0.

    Positions, (F, n_joints, 3), are in the unit and axes of the file; states and confidence are
    (F, n_joints). Times, (F,) in seconds, are used if there is no frame rate.
    """
    if confidence is not None:
        confidence = np.nan_to_num(confidence)
        if not ((confidence >= 0.0) & (confidence <= 1.0)).all():
            raise InvalidFileError(f"{path} has a confidence that is not between 0 and 1.")
    return joint_recording(
        path,
        JointSamples(
            names,
            points_z_up(positions, header.conventions.up),
            header.sensor,
            states=None if states is None else checked_states(np.nan_to_num(states), path),
            confidence=confidence,
            times=times if header.frame_rate is None else None,
            frame_rate=header.frame_rate or 1.0,
        ),
        nan_only=True,
        scale=header.unit if scale is None else scale,
        conventions=header.conventions,
        progress=progress,
    )


def check_names(names: Sequence[str]) -> None:
    """Raise InvalidMotionError for joint names that cannot be stored in one line."""
    wrong = [name for name in names if not name.isprintable() or name != name.strip()]
    if wrong:
        raise InvalidMotionError(
            f"Joint names with line breaks, other control characters or outer spaces cannot be"
            f" written: {', '.join(map(repr, wrong))}. Rename them."
        )
