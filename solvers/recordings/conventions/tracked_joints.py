"""Build a joint recording: mark gaps, resample to a constant rate, and check the unit."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...motion import AxisName, FileConventions, JointRecording, Sensor, Tracks
from ...progress import READING, Progress, Remark
from .body_unit import convert_to_body_unit
from .time_stamps import DEFAULT_FRAME_RATE, ConstantRate

SENSOR_AXES: dict[Sensor, tuple[AxisName, AxisName]] = {
    Sensor.KINECT_V1: ("Y", "-Z"), Sensor.KINECT_V2: ("Y", "-Z"),
    Sensor.AZURE_KINECT: ("-Y", "-Z"),
}  # fmt: skip
"""Axes of each camera's space that are up, and toward the camera (`sensor_axes`)."""


@dataclass(frozen=True, eq=False)
class JointSamples:
    """Joints as a file or a stream has them, in its own unit.

    Attributes
    ----------
    names : sequence of str
    positions : float array, shape (n_frames, n_joints, 3), in the file's unit
        A position that is NaN, exactly 0, or in state 0 was not observed.
    sensor : Sensor
    states : int8 array, shape (n_frames, n_joints), or None
    confidence : float array, shape (n_frames, n_joints), 0 to 1, or None
    times : float array, shape (n_frames,), seconds, or None
        Time of each frame. A recording is resampled to a constant rate (`ConstantRate`), which
        is `frame_rate` if the times agree with it.
    frame_rate : float, hertz
    """

    names: Sequence[str]
    positions: NDArray[np.float64]
    sensor: Sensor = Sensor.OTHER
    states: NDArray[np.int8] | None = None
    confidence: NDArray[np.float64] | None = None
    times: NDArray[np.float64] | None = None
    frame_rate: float = DEFAULT_FRAME_RATE


def joint_recording(
    path: Path | str,
    joints: JointSamples,
    *,
    scale: float | None,
    progress: Progress,
    nan_only: bool = False,
    default_unit: float = 1.0,
    conventions: FileConventions | None = None,
) -> JointRecording:
    """Build a recording from the contents of a file.

    Parameters
    ----------
    path : Path or str
        For error messages.
    joints : JointSamples
        Z is up. Where a joint was not observed, its state becomes 0 and its position NaN.
    scale : float, meters per unit of the file, or None
        None: the default unit, or the unit that gives a human body if the default does not.
    progress : Progress
        Receives a message on resampling, and on the unit if it was estimated.
    nan_only : bool
        True: only NaN was not observed. The origin is a valid position, and a joint that was
        not tracked keeps its position.
    default_unit : float, meters
        Default unit of the format.
    conventions : FileConventions or None
        How the axes were interpreted. None: as the sensor has them.

    Returns
    -------
    JointRecording

    Raises
    ------
    InvalidFileError
        No joint is observed in any frame, or the time stamps are invalid.
    """
    positions, states, confidence = joints.positions, joints.states, joints.confidence
    frame_rate = joints.frame_rate
    missing = ~np.isfinite(positions).all(axis=-1)
    if not nan_only:
        missing |= (positions == 0.0).all(axis=-1)
        missing |= False if states is None else states == 0
    if states is not None:
        states = np.where(missing, 0, states).astype(np.int8)
    positions = np.where(missing[..., None], np.nan, positions)
    if missing.all():
        raise InvalidFileError(f"{path} has no joint that is observed in any frame.")
    if joints.times is not None:
        resampler = ConstantRate(path, joints.times, frame_rate)
        frame_rate = resampler.frame_rate
        positions = resampler.positions(positions)
        states = None if states is None else resampler.states(states)
        confidence = None if confidence is None else resampler.confidence(confidence)
    uneven = f"Resampled to {frame_rate:.4g} Hz from its time stamps"
    progress(1.0, READING if joints.times is None else Remark(uneven))
    unit = default_unit if scale is None else scale
    positions *= unit  # a copy of the argument
    axes = conventions or FileConventions(*SENSOR_AXES.get(joints.sensor, ("Z", "-Y")))
    noted = replace(axes, unit=unit, has_floor=False)
    tracks = Tracks(tuple(joints.names), positions, frame_rate, confidence, noted)
    recording = JointRecording(tracks, states, joints.sensor)
    return recording if scale is not None else convert_to_body_unit(recording, unit, progress)
