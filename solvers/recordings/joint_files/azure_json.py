"""Read the JSON that the Azure Kinect body tracking sample `offline_processor` writes."""

import re
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...motion import SENSOR_JOINTS, JointRecording, Sensor
from ...progress import Progress, unwatched
from ..containers import UniqueNames, array_from_json, json_members, printable
from ..conventions import (
    DEFAULT_FRAME_RATE,
    Bodies,
    bodies_of_frames,
    check_scale,
    from_azure_space,
    joint_recording,
    recorded_seconds,
    stack_body_frames,
)
from .azure_csv import MILLIMETER, azure_joint

MICROSECOND = 1e-6
HEAD = re.compile(rb'\s*\{\s*"(?:[^"]*"[^{}]*")?(k4abt_sdk_version|bone_list|joint_names)"')
Frame = dict[str, NDArray[np.float64]]


def is_azure_json(head: bytes) -> bool:
    """Return whether a file has this format, from its first bytes."""
    return HEAD.match(head) is not None


def open_azure_json(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[JointRecording]:
    """Open `offline_processor` JSON [1]_, in meters, Z up.

    Bodies are identified by their id, in any order. Frames are resampled to a constant rate by
    their time stamps (30 Hz without them); missing frames, and frames without that body, are
    gaps. Orientations are not read. The format has no confidence, so there is no tracking
    state: joints that the tracker only predicted look like all others.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: millimeters.
    progress : Progress

    Returns
    -------
    Bodies of JointRecording
        The joints named in the file, otherwise all 32 in the SDK's order; the camera looks
        along +Y.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, truncated, or has no body.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Microsoft, Azure-Kinect-Samples, body-tracking-samples/offline_processor.
    """
    check_scale(scale)
    frames: list[Frame] = []
    times: list[float] = []
    given = UniqueNames()
    names: list[str] = []
    for member in json_members(path):
        if member.key == "frames":
            location = f"{path}, frame {len(frames) + 1}"
            time, bodies = _read_frame(member.value, location)
            frames.append(bodies)
            times.append(time)
            progress(member.done, "Reading")
        elif member.key == "joint_names":
            names.append(given.give(printable(azure_joint(str(member.value)))))
    if not any(frames):
        raise InvalidFileError(f"{path} has {len(frames)} frames but no body in any of them.")
    joints = names or list(SENSOR_JOINTS[Sensor.AZURE_KINECT])
    n_positions = {len(positions) for frame in frames for positions in frame.values()}
    if n_positions != {len(joints)}:
        raise InvalidFileError(
            f"{path}: not every body has a position for each of the {len(joints)} joints. The"
            " file is damaged; export it again."
        )
    stamps = None if np.isnan(times).all() else MICROSECOND * np.array(times)
    untimed = len(frames) / DEFAULT_FRAME_RATE
    keys, listed = bodies_of_frames(
        frames, untimed if stamps is None else recorded_seconds(stamps)
    )

    def read(index: int, progress: Progress) -> JointRecording:
        return joint_recording(
            path,
            joints,
            from_azure_space(stack_body_frames(keys[index], frames)),
            Sensor.AZURE_KINECT,
            times=stamps,
            scale=scale,
            default_unit=MILLIMETER,
            progress=progress,
        )

    return Bodies(str(path), listed, read)


def _read_frame(frame: Any, location: str) -> tuple[float, Frame]:
    """Return the time stamp, or NaN, and the joint positions of each body."""
    listed = frame.get("bodies", []) if isinstance(frame, dict) else None
    if not isinstance(listed, list) or not all(isinstance(body, dict) for body in listed):
        raise InvalidFileError(
            f"{location}: a list of bodies is required. The file is damaged; export it again."
        )
    bodies: Frame = {}
    for count, body in enumerate(listed, start=1):
        positions = array_from_json(
            body.get("joint_positions"), (-1, 3), f"{location}, joint_positions"
        )
        bodies.setdefault(str(body.get("body_id", count)), positions)
    time = array_from_json(frame.get("timestamp_usec"), (), f"{location}, timestamp_usec")
    return float(time), bodies
