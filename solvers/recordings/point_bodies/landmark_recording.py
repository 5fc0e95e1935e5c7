"""Make recordings of MediaPipe's landmarks, of the world or triangulated by cameras."""

from pathlib import Path

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import AxisName, JointRecording, Sensor, roles_by_name
from ...motion.skeletons import BODY_POINTS
from ...progress import Progress, Remark
from ..conventions import (
    DEFAULT_FRAME_RATE,
    JointSamples,
    UpAxis,
    describe_guessed_axis,
    estimate_up_of_joints,
    from_azure_space,
    joint_recording,
    no_body_error,
    z_up_from_y_up,
)
from .mediapipe_landmarks import (
    LANDMARK_JOINTS,
    N_POINTS,
    is_of_picture,
    is_world,
    with_computed_joints,
)
from .named_points import body_of_named_points
from .point_arrays import stand_body

UP_OF_WORLD: dict[AxisName, float] = {"-Y": 0.5, "Y": 0.0, "Z": 0.0}
"""Weight of the evidence of each axis, 0 to 1, in world landmarks. Chosen by hand: half of a
body that stands along another axis, 1, since a program turned it. By definition of MediaPipe Y
is down."""
PERCENT = 100.0
"""Confidence of 1 in percent. By definition of percent."""
MIN_PERCENT = 2.0
"""Largest confidence of a take, a ratio, above which it is in percent. Chosen by hand: it
guards scores from 0 to 1 that exceed 1 a little."""


def recording_from_landmarks(
    path: Path | str,
    landmarks: Array,
    times: Array | None,
    frame_rate: float | None,
    scale: float | None,
    progress: Progress,
) -> JointRecording:
    """Return the recording of world landmarks, or of landmarks that cameras triangulated.

    World landmarks have the hips at the origin, x right, y down, z away from the camera. Axes
    and unit of others are estimated from the body: triangulated ones, and those that a program
    has turned so that the actor stands.

    Parameters
    ----------
    path : Path or str
        For error messages.
    landmarks : shape (n_frames, 33, 4)
        x, y and z, NaN where not observed; visibility from 0 to 1 or in percent, or NaN.
    times : seconds, shape (n_frames,), or None
    frame_rate : hertz, or None
    scale : meters per unit of the file, or None
    progress : Progress

    Raises
    ------
    InvalidFileError
        The landmarks are those of a picture, or none is observed.
    """
    points = landmarks[..., :3]
    visibility = as_fractions(landmarks[..., 3], points)
    if np.isnan(points).all():
        raise no_body_error(path)
    is_centered = is_world(points)
    if is_centered:
        progress(
            0.9, Remark("MediaPipe keeps the hips at the origin, so the actor does not travel")
        )
    elif is_of_picture(points):
        raise InvalidFileError(
            f"{path} has image landmarks, without true depth. Save the pose_world_landmarks of"
            " MediaPipe instead."
        )
    up = _estimate_up(points) if is_centered else None
    if up and (up.axis != "-Y" or not up.is_clear):
        progress(0.9, Remark(describe_guessed_axis(up.axis)))
    if up is None or up.axis != "-Y":
        return _converted(path, points, visibility, times, frame_rate, scale, progress)
    _say_missing_rate(times, frame_rate, progress)
    return joint_recording(
        path,
        JointSamples(
            LANDMARK_JOINTS,
            with_computed_joints(from_azure_space(points)),
            Sensor.MEDIAPIPE,
            confidence=None if visibility is None else with_computed_joints(visibility),
            times=times,
            frame_rate=frame_rate or DEFAULT_FRAME_RATE,
        ),
        nan_only=True,
        scale=scale,
        progress=progress,
    )


def as_fractions(confidence: Array, points: Array) -> Array | None:
    """Return confidence from 0 to 1, which may be stated in percent; None if none is stated.

    Points that are observed without a confidence have 1, others 0.

    Parameters
    ----------
    confidence : shape (n_frames, n_points), NaN where it is not stated
    points : shape (n_frames, n_points, 3), NaN where not observed
    """
    if np.isnan(confidence).all():
        return None
    is_percent = MIN_PERCENT < np.nanmax(confidence) <= PERCENT
    fractions = confidence / PERCENT if is_percent else confidence
    observed = np.isfinite(points).all(axis=-1)
    return np.clip(np.where(np.isnan(fractions), observed, fractions), 0.0, 1.0)


def _estimate_up(points: Array) -> UpAxis:
    """Return the axis along which the actor of world landmarks stands."""
    roles = {role: LANDMARK_JOINTS.index(name)
             for role, name in roles_by_name(LANDMARK_JOINTS).items()}  # fmt: skip
    positions = with_computed_joints(z_up_from_y_up(points))
    return estimate_up_of_joints(positions, roles, UP_OF_WORLD)


def _converted(
    path: Path | str,
    points: Array,
    visibility: Array | None,
    times: Array | None,
    frame_rate: float | None,
    scale: float | None,
    progress: Progress,
) -> JointRecording:
    observed = [at for at in range(N_POINTS) if np.isfinite(points[:, at]).all(axis=-1).any()]
    names = [BODY_POINTS[at] for at in observed]
    body = body_of_named_points(names, points[:, observed])
    if body is None:
        raise InvalidFileError(
            f"{path} has joints called {', '.join(names[:3])} ..., which do not form a body."
            " Store them as a joint CSV."
        )
    _say_missing_rate(times, frame_rate, progress)
    joints = [LANDMARK_JOINTS.index(name) for name in body.names if name in LANDMARK_JOINTS]
    return stand_body(
        path,
        JointSamples(
            body.names,
            body.positions,
            frame_rate=frame_rate or DEFAULT_FRAME_RATE,
            times=times,
            confidence=None
            if visibility is None
            else with_computed_joints(visibility)[:, joints],
        ),
        scale=scale,
        progress=progress,
    )


def _say_missing_rate(
    times: Array | None, frame_rate: float | None, progress: Progress
) -> None:
    if times is None and frame_rate is None:
        progress(
            0.9, Remark(f"The file has no frame rate; {DEFAULT_FRAME_RATE:g} Hz is assumed")
        )
