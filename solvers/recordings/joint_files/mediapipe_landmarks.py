"""Names, axes and the check for flat landmarks for all readers of MediaPipe's landmarks."""

from pathlib import Path

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import JointRecording, Sensor
from ...motion.skeletons import BODY_POINTS, COMPUTED_JOINTS
from ...progress import Progress, Remark
from ..conventions import DEFAULT_FRAME_RATE, from_azure_space, joint_recording

N_POINTS = len(BODY_POINTS)
LANDMARK_JOINTS = (*BODY_POINTS, *COMPUTED_JOINTS)
HIPS = [BODY_POINTS.index("left_hip"), BODY_POINTS.index("right_hip")]
MAX_FRAME_S = 2.0
"""Typical step between frames, seconds, above which stamps are milliseconds. Chosen by hand:
steps of 5 to 100 Hz are 0.01 to 0.2 s, or 10 to 200 ms."""
MILLISECOND = 1e-3
MAX_CENTER_FRACTION = 0.2
"""Distance of the middle of the hips from the origin, relative to the size of the body, up to
which landmarks are those of the world, whose origin is there. It is meant for landmarks of the
image, whose origin is a corner. Chosen by hand: x0.5 and x2 fail no test of this module."""
MIN_INSIDE = 0.95
"""Coordinates in a picture, a fraction of all. It guards takes of scenes, with a third and more
outside; MediaPipe also guesses limbs that leave the picture."""


def seconds(stamps: Array) -> Array:
    """Return stamps of unstated unit in seconds: they may be milliseconds."""
    steps = np.diff(stamps[np.isfinite(stamps)])
    is_long = len(steps) and np.median(steps) > MAX_FRAME_S
    return np.asarray(MILLISECOND * stamps if is_long else stamps)


def is_world(points: Array) -> bool:
    """Return whether landmarks, shape (n_frames, 33, 3), are in the world, not in a picture."""
    center = points[:, HIPS].mean(axis=1)
    size = np.nanmax(np.ptp(points, axis=1), axis=1, initial=0.0)
    known = np.isfinite(center).all(axis=1) & (size > 0.0)
    if not known.any():
        return False
    away = np.linalg.norm(center[known], axis=1) / size[known]
    return bool(np.median(away) <= MAX_CENTER_FRACTION)


def is_normalized(points: Array) -> bool:
    """Return whether 33 landmarks, shape (n_frames, 33, 3), are fractions of a picture's size.

    A person of 1.5 m and more who stands in a scene exceeds 0 to 1 meter.
    """
    flat = points[..., :2][np.isfinite(points).all(axis=-1)]
    inside = (flat >= 0.0) & (flat <= 1.0)
    return bool(inside.mean() >= MIN_INSIDE) and not is_world(points)


def recording_from_landmarks(
    path: Path | str,
    landmarks: Array,
    times: Array | None,
    frame_rate: float | None,
    scale: float | None,
    progress: Progress,
) -> JointRecording:
    """Return the recording of world landmarks: x right, y down, z away from the camera.

    Parameters
    ----------
    path : Path or str
        For error messages.
    landmarks : shape (n_frames, 33, 4)
        x, y and z in meters, NaN in frames without a body; visibility from 0 to 1, or NaN.
    times : seconds, shape (n_frames,), or None
    frame_rate : hertz, or None
    scale : meters per unit of the file, or None
    progress : Progress

    Raises
    ------
    InvalidFileError
        The landmarks are those of a picture, or none is observed.
    """
    points, visibility = landmarks[..., :3], np.clip(landmarks[..., 3], 0.0, 1.0)
    if np.isnan(points).all():
        raise InvalidFileError(f"{path} has {len(points)} frames but no body in any of them.")
    if not is_world(points):
        raise InvalidFileError(
            f"{path} has image landmarks, without true depth. Save the pose_world_landmarks of"
            " MediaPipe instead."
        )
    if times is None and frame_rate is None:
        progress(
            0.9, Remark(f"The file has no frame rate; {DEFAULT_FRAME_RATE:g} Hz is assumed")
        )
    progress(
        0.9, Remark("MediaPipe keeps the hips at the origin, so the actor does not travel")
    )
    return joint_recording(
        path,
        LANDMARK_JOINTS,
        with_computed_joints(from_azure_space(points)),
        Sensor.MEDIAPIPE,
        confidence=(
            None
            if np.isnan(visibility).all()
            else with_computed_joints(np.nan_to_num(visibility))
        ),
        times=times,
        frame_rate=frame_rate or DEFAULT_FRAME_RATE,
        nan_only=True,
        scale=scale,
        progress=progress,
    )


def with_computed_joints(values: Array) -> Array:
    """Add the mean of the landmarks next to each computed joint, missing where one of them is.

    Parameters
    ----------
    values : shape (n_frames, 33, ...)

    Returns
    -------
    Array, shape (n_frames, n_joints, ...)
        Those of `LANDMARK_JOINTS`.
    """
    groups = [[BODY_POINTS.index(side) for side in sides] for sides in COMPUTED_JOINTS.values()]
    means = [values[:, group].mean(axis=1) for group in groups]
    return np.concatenate([values, np.stack(means, axis=1)], axis=1)
