"""Read the JSON that the body tracking samples of the ZED SDK write."""

import re
from pathlib import Path
from typing import Any

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import JointRecording, Sensor
from ...motion.skeletons import ZED_BODIES
from ...progress import Progress, Remark, unwatched
from ..containers import array_from_json
from ..conventions import (
    Bodies,
    JointSamples,
    check_scale,
    is_mirrored,
    joint_recording,
    stand_along,
)
from .json_bodies import (
    BodiesFrame,
    BodyJoints,
    checked_objects,
    json_frames,
    name_of_body,
    number,
    open_frames,
    stack_body,
)

HEAD = re.compile(rb'\s*[\[{].*"(body_list|is_tracked)"\s*:', re.DOTALL)
KEYS = frozenset({"body_list", "is_tracked"})
NANOSECOND = 1e-9
SIDE_SUFFIXES = ("Left", "Right")
MEANS = {"Pelvis": ("HipLeft", "HipRight"), "Head": ("EarLeft", "EarRight")}
"""Joints that some formats lack, each computed as the mean of two."""


def is_zed_json(head: bytes) -> bool:
    """Return whether the first bytes are those of a frame of the ZED SDK."""
    return HEAD.match(head) is not None


def open_zed_json(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[JointRecording]:
    """Open bodies of the ZED SDK [1]_ with 18, 34 or 38 joints, in meters, Z up.

    Bodies are identified by their id. Frames are resampled to a constant rate by their time
    stamps. The file states neither axes nor unit: up is the direction from the ankles to the
    head, left-handed axes are recognized by the sides of the body, and the unit by its size.
    Confidence is that of the keypoints.
    Joints are called as those of the Azure Kinect; pelvis and head are added where the format
    has none, as the means of hips and of ears.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: meters, unless these do not give a human body.
    progress : Progress

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
    .. [1] Stereolabs, zed-sdk, body tracking/export/JSON export.
    """
    check_scale(scale)
    frames: list[BodiesFrame] = []
    for key, value, done in json_frames(path, KEYS):
        frames.append(_read_frame(key, value, done, f"{path}, frame {len(frames) + 1}"))
        progress(done, "Reading")
    return open_frames(
        path, frames, NANOSECOND, lambda *found: _recording(path, scale, *found), progress
    )


def _recording(
    path: Path | str,
    scale: float | None,
    frames: list[BodiesFrame],
    body: str,
    times: Array | None,
    progress: Progress,
) -> JointRecording:
    n_joints = {
        len(found[body].positions)
        for found in (frame.bodies for frame in frames)
        if body in found
    }
    if len(n_joints) != 1 or not n_joints <= ZED_BODIES.keys():
        raise InvalidFileError(
            f"{path} has bodies of {', '.join(map(str, sorted(n_joints)))} joints; those of 18,"
            " 34 or 38 are read. Export one of these."
        )
    positions, confidence = stack_body(body, frames)
    names = list(ZED_BODIES[positions.shape[1]])
    positions, confidence = _with_means(names, positions, confidence)
    ankles = [names.index(f"Ankle{side}") for side in SIDE_SUFFIXES]
    positions = stand_along(positions, [names.index("Neck")], ankles)
    left, right = (names.index(f"Shoulder{side}") for side in SIDE_SUFFIXES)
    if is_mirrored(positions, left, right, names.index("Neck"), names.index("Nose")):
        positions = positions * (1.0, -1.0, 1.0)
        progress(0.0, Remark("The axes of the file are left-handed; the body is mirrored back"))
    return joint_recording(
        path,
        JointSamples(names, positions, Sensor.ZED, confidence=confidence, times=times),
        scale=scale,
        progress=progress,
    )


def _with_means(
    names: list[str], positions: Array, confidence: Array | None
) -> tuple[Array, Array | None]:
    """Add the joints of `MEANS` that are missing, in place to the names."""
    for name, sides in MEANS.items():
        if name in names:
            continue
        pair = [names.index(side) for side in sides]
        center = positions[:, pair].mean(axis=1, keepdims=True)
        positions = np.concatenate([positions, center], axis=1)
        if confidence is not None:
            lower = confidence[:, pair].min(axis=1, keepdims=True)
            confidence = np.concatenate([confidence, lower], axis=1)
        names.append(name)
    return positions, confidence


def _read_frame(key: str, value: dict[str, Any], done: float, location: str) -> BodiesFrame:
    bodies: dict[str, BodyJoints] = {}
    for count, body in enumerate(checked_objects(value.get("body_list"), location)):
        if not body.get("keypoint"):
            continue
        positions = array_from_json(body["keypoint"], (-1, 3), f"{location}, keypoint")
        known = body.get("keypoint_confidence")
        confidence = np.full(len(positions), np.nan)
        if known is not None:
            confidence = array_from_json(
                known, (len(positions),), f"{location}, keypoint_confidence"
            )
        bodies.setdefault(name_of_body(body, ("id",), count), BodyJoints(positions, confidence))
    time = number(value.get("timestamp"), f"{location}, timestamp")
    if np.isnan(time) and key.isascii() and key.isdigit() and len(key) < 20:
        time = 1e6 * float(key)  # milliseconds
    return BodiesFrame(time, bodies, done)
