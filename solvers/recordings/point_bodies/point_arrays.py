"""Read arrays of the joints of one body, which state nothing but their shape."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import AxisName, JointRecording, Sensor, roles_by_name
from ...motion.humanoid import SIDES
from ...progress import Progress, Remark
from ..conventions import (
    DEFAULT_FRAME_RATE,
    SWAPPED,
    JointSamples,
    conventions_of,
    describe_guessed_axis,
    estimate_up_of_joints,
    file_conventions,
    is_mirrored,
    joint_recording,
    reinterpreted,
    with_conventions,
    z_up_from_y_up,
)
from .depth_of_points import has_depth
from .mediapipe_landmarks import N_POINTS, is_inside_picture, is_normalized
from .refuse_angles import refuse_angles
from .relative_positions import refuse_parent_positions, report_still_hips
from .unknown_units import (
    are_scaled_by_frame,
    has_size_of_person,
    with_adult_size,
    with_constant_lengths,
)
from .unnamed_joints import NamedJoints, has_layout, name_joints

UP: dict[AxisName, float] = {"Y": 0.2, "Z": 0.2, "-Y": 0.2}
"""Weight, 0 to 1, of each possible axis. Chosen by hand below `FLOOR_WEIGHT`, 0.3."""
UP_OF_SMPL: dict[AxisName, float] = {"Y": 0.8, "Z": 0.0, "-Y": 0.0}
"""The same weight for HumanML3D, which has Y up by definition of the data set."""
SMPL = "SMPL"
"""Layout of HumanML3D."""
HUMANML3D_RATE_HZ = 20.0
"""Frames per second of HumanML3D, hertz, by definition of the data set."""
SENSORS = {
    "Kinect v1": Sensor.KINECT_V1, "UTD-MHAD": Sensor.KINECT_V1,
    "Kinect v2 or NTU": Sensor.KINECT_V2, "Azure Kinect": Sensor.AZURE_KINECT,
    "MediaPipe": Sensor.MEDIAPIPE, "ZED 34": Sensor.ZED, "ZED 38": Sensor.ZED,
}  # fmt: skip
"""Camera or tracker of a layout."""
MIN_PIXELS = 10.0
"""Extent of a person in a picture, pixels; bodies in meters are smaller. It guards scores of
2D points, 0 to 1, from being read as depth."""
MIN_FLEXION = 0.03
"""Distance of the knee from the line between hip and ankle, relative to the leg, that shows
where the body faces. It guards straight legs, whose knees are noise."""


def body_of_points(path: Path | str, points: NDArray[np.float64]) -> NamedJoints | None:
    """Return the joints of an array, shape (n_frames, n_points, 3), if they form a body.

    Raises
    ------
    InvalidFileError
        The points lie in a picture.
    """
    if has_layout(points.shape[1]):
        refuse_pictures(path, points)
    if points.shape[1] == N_POINTS and np.isfinite(points).any() and is_normalized(points):
        raise _flat(path)
    return name_joints(points) if has_layout(points.shape[1]) else None


def points_of_array(path: Path | str, array: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return an array as points over time, shape (n_frames, n_points, 3).

    Of a body, coordinates may also be the first or the second axis, or all be in one row. A
    fourth coordinate is the confidence: points without any are not observed.

    Raises
    ------
    InvalidFileError
        The array has another shape, or no depth.
    """
    if array.ndim == 4 and 1 in array.shape[:2]:
        array = np.squeeze(array, axis=array.shape.index(1))
    shape = array.shape
    if array.ndim == 3 and shape[2] == 2 and has_layout(shape[1]):
        raise _flat(path)
    for points in _as_points(array):
        if points.shape[2] == 3 and (points is array or has_layout(points.shape[1])):
            return points
    raise InvalidFileError(
        f"{path} holds an array of shape {shape}; points over time have the shape (frames,"
        " points, 3)."
    )


def _as_points(array: NDArray[np.float64]) -> Iterator[NDArray[np.float64]]:
    """Yield an array in all orders of its axes that may be (frames, points, coordinates)."""
    if array.ndim == 3:
        yield array
        if array.shape[2] == 4:
            yield without_undetected(array)
        yield np.moveaxis(array, 1, 2)
        yield np.moveaxis(array, 2, 0)
        yield np.moveaxis(array, 0, 2)
    elif array.ndim == 2 and array.shape[1] % 3 == 0:
        rows = array.reshape(len(array), -1, 3)
        if has_layout(rows.shape[1]) and name_joints(rows) is not None:
            yield rows


def without_undetected(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the coordinates of points, NaN where the fourth value, a confidence, is 0.

    Where all of them are 0, nothing was measured: only points at the origin are not observed.

    Parameters
    ----------
    points : shape (..., n_points, 4)
    """
    is_undetected = points[..., 3:] == 0.0
    if is_undetected.all():
        is_undetected = ~points.any(axis=-1, keepdims=True)
    return np.where(is_undetected, np.nan, points[..., :3])


def read_body(
    path: Path | str,
    body: NamedJoints,
    scale: float | None,
    progress: Progress,
    times: Array | None = None,
    rate: float | None = None,
) -> JointRecording:
    """Return a recognized body in meters, Z up, with what was estimated.

    Without times, (F,) in seconds, and rate, in hertz, the rate of the format is assumed.
    """
    default_rate = HUMANML3D_RATE_HZ if body.layout == SMPL else DEFAULT_FRAME_RATE
    assumed = f". {default_rate:g} Hz is assumed" if times is None and rate is None else ""
    progress(
        0.8,
        Remark(
            "The joints have no known names; by their bones they are in the order of"
            f" {body.layout} with {body.confidence:.0%} confidence{assumed}"
        ),
    )
    return stand_body(
        path,
        JointSamples(
            body.names,
            body.positions,
            frame_rate=rate or default_rate,
            times=times,
            sensor=SENSORS.get(body.layout, Sensor.OTHER),
        ),
        up=UP_OF_SMPL if body.layout == SMPL else UP,
        scale=scale,
        progress=progress,
    )


def stand_body(
    path: Path | str,
    joints: JointSamples,
    *,
    up: Mapping[AxisName, float] = UP,
    scale: float | None,
    progress: Progress,
) -> JointRecording:
    """Return joints whose axes, sides and unit are unknown as a body in meters, Z up.

    Parameters
    ----------
    path : Path or str
    joints : JointSamples
        With names of humanoid roles; NaN where not observed; in the axes of the file.
    up : evidence of the format for each axis
    scale : float, meters per unit of the file, or None
    progress : Progress
        Receives what was estimated.
    """
    names, positions = tuple(joints.names), z_up_from_y_up(joints.positions)
    roles = {role: names.index(name) for role, name in roles_by_name(names).items()}
    estimated = estimate_up_of_joints(positions, roles, up)
    refuse_parent_positions(path, positions, roles)
    refuse_angles(path, names, positions)
    report_still_hips(positions, roles, progress)
    has_unit = not are_scaled_by_frame(positions)
    positions = positions if has_unit else with_constant_lengths(names, positions)
    if not estimated.is_clear:
        progress(0.8, Remark(describe_guessed_axis(estimated.axis)))
    recording = joint_recording(
        path,
        replace(joints, positions=positions),
        nan_only=True,
        scale=scale,
        conventions=file_conventions("Y"),
        progress=progress,
    )
    standing = _with_sides_corrected(reinterpreted(recording, estimated.axis, None), progress)
    noted = replace(conventions_of(standing), confidence=estimated.confidence)
    standing = with_conventions(standing, noted)
    if scale is None and not (has_unit and has_size_of_person(standing)):
        return with_adult_size(standing, noted, progress)
    return standing


def _with_sides_corrected(recording: JointRecording, progress: Progress) -> JointRecording:
    """Mirror a body whose front shows that its left side is on the right."""
    points = recording.tracks.positions
    named = roles_by_name(recording.names)
    joints = {role: points[:, recording.names.index(name)] for role, name in named.items()}
    front = _front(joints)
    sides = [joints[f"{side}UpperLeg"] for side in SIDES]
    shown = np.stack([*sides, np.zeros_like(front), front], axis=1)
    if not is_mirrored(shown, 0, 1, 2, 3):
        return recording
    progress(1.0, Remark(SWAPPED))
    mirrored = recording.tracks.with_positions(points * np.array([-1.0, 1.0, 1.0]))
    noted = replace(conventions_of(recording), is_mirrored=True)
    return recording.with_tracks(replace(mirrored, conventions=noted))


def _front(joints: Mapping[str, Array]) -> Array:
    """Return where feet or, without toes, bent knees point; NaN where neither does."""
    if {f"{side}Toes" for side in SIDES} <= joints.keys():
        return np.asarray(sum(joints[f"{side}Toes"] - joints[f"{side}Foot"] for side in SIDES))
    front = np.zeros_like(joints["leftFoot"])
    for side in SIDES:
        hip, knee, ankle = (joints[side + part] for part in ("UpperLeg", "LowerLeg", "Foot"))
        flexion = knee - (hip + ankle) / 2.0
        is_bent = np.linalg.norm(flexion, axis=1) > MIN_FLEXION * np.linalg.norm(
            hip - ankle, axis=1
        )
        front += np.where(is_bent[:, None], flexion, 0.0)
    return np.where((front != 0.0).any(axis=1, keepdims=True), front, np.nan)


def refuse_pictures(path: Path | str, points: Array) -> None:
    """Refuse 2D points of a body with a score, or nothing, as the third coordinate.

    Parameters
    ----------
    points : shape (n_frames, n_points, 3), NaN where not observed

    Raises
    ------
    InvalidFileError
        The points lie in a picture.
    """
    observed = points[np.isfinite(points).all(axis=2).any(axis=1)]
    if not len(observed):
        return
    third = observed[..., 2][np.isfinite(observed[..., 2])]
    extents = np.nanmax(observed[..., :2], axis=1) - np.nanmin(observed[..., :2], axis=1)
    is_score = third.min() >= 0.0 and third.max() <= 1.0
    is_flat = np.median(extents.max(axis=1)) > MIN_PIXELS or (
        is_inside_picture(observed) and not has_depth(observed)
    )
    if (is_score and is_flat) or np.ptp(third) == 0.0:
        raise _flat(path)


def _flat(path: Path | str) -> InvalidFileError:
    return InvalidFileError(
        f"{path} holds 2D points of images, without depth. Import the 3D joints of your"
        " tracker, shape (frames, joints, 3)."
    )
