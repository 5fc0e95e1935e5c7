"""Read the JSON that the Azure Kinect body tracking sample `offline_processor` writes."""

import re
from pathlib import Path
from typing import Any

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import SENSOR_JOINTS, JointRecording, Sensor
from ...progress import Progress, unwatched
from ..containers import UniqueNames, array_from_json, json_members, printable
from ..conventions import (
    MILLIMETER,
    Bodies,
    JointSamples,
    check_scale,
    from_azure_space,
    joint_recording,
)
from .azure_csv import azure_joint
from .json_bodies import (
    BodiesFrame,
    BodyJoints,
    checked_objects,
    name_of_body,
    number,
    open_frames,
    position_of,
    stack_body,
)

MICROSECOND = 1e-6
HEAD = re.compile(rb'\s*\{\s*"(?:[^"]*"[^{}]*")?(k4abt_sdk_version|bone_list|joint_names)"')
OWN_NAMES = (b"k4abt_sdk_version", b"bone_list", b"SPINE_NAVEL")
"""Names in files of the Azure Kinect, one in each; other formats list names of joints, too."""


def is_azure_json(head: bytes) -> bool:
    """Return whether a file has this format, from its first bytes."""
    return HEAD.match(head) is not None and any(name in head for name in OWN_NAMES)


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
    frames: list[BodiesFrame] = []
    given = UniqueNames()
    names: list[str] = []
    for member in json_members(path):
        if member.key == "frames":
            location = f"{path}, frame {len(frames) + 1}"
            frames.append(_read_frame(member.value, member.done, location))
            progress(member.done, "Reading")
        elif member.key == "joint_names":
            names.append(given.give(printable(azure_joint(str(member.value)))))
    joints = names or list(SENSOR_JOINTS[Sensor.AZURE_KINECT])
    observed = [body for frame in frames for body in frame.bodies.values()]
    if any(len(body.positions) != len(joints) for body in observed):
        raise InvalidFileError(
            f"{path}: not every body has a position for each of the {len(joints)} joints. The"
            " file is damaged; export it again."
        )

    def read(
        frames: list[BodiesFrame], body: str, times: Array | None, progress: Progress
    ) -> JointRecording:
        positions, _ = stack_body(body, frames)
        return joint_recording(
            path,
            JointSamples(joints, from_azure_space(positions), Sensor.AZURE_KINECT, times=times),
            scale=scale,
            default_unit=MILLIMETER,
            progress=progress,
        )

    return open_frames(path, frames, MICROSECOND, read, progress)


def _read_frame(frame: Any, done: float, location: str) -> BodiesFrame:
    """Return the time stamp, or NaN, and the joint positions of each body."""
    if not isinstance(frame, dict):
        raise InvalidFileError(f"{location}: a frame is required. Export the file again.")
    bodies: dict[str, BodyJoints] = {}
    for count, body in enumerate(checked_objects(frame.get("bodies"), location), start=1):
        listed_positions = body.get("joint_positions")
        if isinstance(listed_positions, list):
            listed_positions = [*map(position_of, listed_positions)]
        positions = array_from_json(listed_positions, (-1, 3), f"{location}, joint_positions")
        found = BodyJoints(positions, np.full(len(positions), np.nan))
        bodies.setdefault(name_of_body(body, ("body_id",), count), found)
    time = number(frame.get("timestamp_usec"), f"{location}, timestamp_usec")
    return BodiesFrame(time, bodies, done)
