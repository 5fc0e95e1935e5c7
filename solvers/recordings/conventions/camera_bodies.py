"""Rotate bodies upright if the file of their camera does not state its axes, or its tilt."""

from collections.abc import Sequence
from typing import TypeVar, cast

import numpy as np

from ...arrays import Array
from ...errors import InvalidMotionError
from ...motion import AxisName, JointRecording, Motion, Sensor, Tracks
from ...motion.humanoid import (
    POSTURE_JOINTS,
    SIDES,
    posture_positions,
    postures_from_motion,
)
from ...progress import Progress, Remark
from ...rotations import rotate, rotation_between
from .file_axes import rotate_motion
from .floor import lacks_floor
from .points import points_z_up

Recording = TypeVar("Recording", bound=Motion | Tracks | JointRecording)

MIN_MIRRORED_FRACTION = 0.8
"""Fraction of the frames in which left and right are swapped, of mirrored axes. Chosen by
hand: x2 fails `test_a_body_of_the_zed_stands_in_any_axes`."""
MAX_LEAN_DEG, LYING_DEG = 15.0, 45.0
"""Angle between the vertical and the line from the ankles to the shoulders of a standing actor,
from which the camera was tilted, and from which another axis is up. Measured: it is at most
12.5 in 276 takes with a floor; by definition the second is half the angle between two axes."""
MAX_LEAN_BEFORE_KINECT_DEG = 8.0
"""The same angle for sensors whose axes are always those of the camera. Measured: it is at most
7.0 in 102 of 105 takes of CMU, HDM05 and others with a floor, and 8.8 to 12.8 in 17 of 25 takes
of the Kinect in IRDS."""
KINECTS = (Sensor.KINECT_V1, Sensor.KINECT_V2, Sensor.AZURE_KINECT)
MIN_STRAIGHT = 0.95
"""Distance from hip to ankle, relative to the bones, of a leg that is straight. Chosen by hand:
it guards poses in which the hips are behind the feet."""
MAX_BEND_DEG = 25.0
"""Angle between trunk and legs of an actor who stands straight, degrees. It guards those who
sit with straight legs, or bow. Measured: those whom a camera lets lean have 3 to 7."""
MIN_STANDING_FRACTION = 0.2
"""Fraction of the frames with both legs straight. Measured: in kicks of HDM05, whose legs are
straight in less than 0.1, one of them is raised."""


def up_along(points: Array, high: Sequence[int], low: Sequence[int]) -> AxisName:
    """Return the axis along which some points are above others; Z if none are observed.

    Parameters
    ----------
    points : shape (n_frames, n_points, 3)
    high, low : indices of points, such as of the head and of both ankles
    """
    displacements = points[:, high].mean(axis=1)[:, None] - points[:, low]
    known = displacements[np.isfinite(displacements).all(axis=-1)]
    if not len(known):
        return "Z"
    up = np.median(known, axis=0)
    axis = int(np.argmax(np.abs(up)))
    return cast(AxisName, ("-" if up[axis] < 0.0 else "") + "XYZ"[axis])


def stand_along(points: Array, high: Sequence[int], low: Sequence[int]) -> Array:
    """Rotate points (n_frames, n_points, 3) by quarter turns: some are above others.

    `high` and `low` are their indices (`up_along`).
    """
    return points_z_up(points, up_along(points, high, low))


def is_mirrored(points: Array, left: int, right: int, back: int, front: int) -> bool:
    """Whether the left side is on the right in most frames, as in left-handed axes.

    Parameters
    ----------
    points : shape (n_frames, n_points, 3), Z up
    left, right : indices of points on the left and the right, such as the shoulders
    back, front : indices of points behind and in front, such as an ear and the nose
    """
    across, ahead = (
        points[:, one, :2] - points[:, other, :2]
        for one, other in ((left, right), (front, back))
    )
    handedness = across[:, 0] * ahead[:, 1] - across[:, 1] * ahead[:, 0]
    handedness = handedness[np.isfinite(handedness) & (handedness != 0.0)]
    return bool(len(handedness) and (handedness > 0.0).mean() > MIN_MIRRORED_FRACTION)


def level(recording: Recording, progress: Progress) -> Recording:
    """Turn an actor without a measured floor upright, whom a tilted camera lets lean."""
    up = up_of_leaning(recording)
    if up is None:
        return recording
    lean = np.degrees(np.arccos(up[2]))
    progress(
        1.0,
        Remark(
            f"The actor leans by {lean:.0f} degrees while standing, as where a camera is"
            " tilted, and is turned upright; set Up if this is not right"
        ),
    )
    rotation = rotation_between(up, np.array([0.0, 0.0, 1.0]))
    if isinstance(recording, Motion):
        return cast(Recording, rotate_motion(recording, rotation, np.array([1.0, 0, 0, 0])))
    tracks = recording.tracks if isinstance(recording, JointRecording) else recording
    turned = tracks.with_positions(rotate(rotation, tracks.positions))
    if isinstance(recording, JointRecording):
        return cast(Recording, recording.with_tracks(turned))
    return cast(Recording, turned)


def question_of_lean(recording: Motion | Tracks | JointRecording) -> str:
    """Ask about an actor without a measured floor who leans while both legs are straight."""
    up = up_of_leaning(recording)
    if up is None:
        return ""
    lean = np.degrees(np.arccos(up[2]))
    return (
        f"The actor leans by {lean:.0f} degrees while standing, as where a camera is tilted;"
        " set Place on Floor to Auto, or rotate the armature"
    )


def up_of_leaning(recording: Motion | Tracks | JointRecording) -> Array | None:
    """Return the direction, (3,), from ankles to shoulders of a standing actor, if tilted.

    It is None where a floor was measured, and where the legs are rarely straight.
    """
    if isinstance(recording, Tracks):
        return None
    try:
        posture = (
            postures_from_motion(recording)
            if isinstance(recording, Motion)
            else posture_positions(recording)
        )
    except InvalidMotionError:  # no hips
        return None
    hips, knees, ankles, shoulders = (
        np.stack([posture[:, POSTURE_JOINTS.index(side + part)] for side in SIDES])
        for part in ("UpperLeg", "LowerLeg", "Foot", "UpperArm")
    )
    along = np.linalg.norm(hips - knees, axis=2) + np.linalg.norm(knees - ankles, axis=2)
    is_straight = (np.linalg.norm(hips - ankles, axis=2) > MIN_STRAIGHT * along).all(axis=0)
    legs, trunk = (hips - ankles).mean(axis=0), (shoulders - hips).mean(axis=0)
    lines = legs + trunk
    lengths = np.linalg.norm(lines, axis=1)
    along = np.linalg.norm(legs, axis=1) * np.linalg.norm(trunk, axis=1)
    is_straight &= (legs * trunk).sum(axis=1) > np.cos(np.radians(MAX_BEND_DEG)) * along
    stands = is_straight & np.isfinite(lengths) & (lengths > 0.0)
    if stands.mean() < MIN_STANDING_FRACTION:
        return None
    up = np.median(lines[stands] / lengths[stands, None], axis=0)
    up /= max(np.linalg.norm(up), 1e-9)
    is_kinect = isinstance(recording, JointRecording) and recording.sensor in KINECTS
    max_lean = MAX_LEAN_BEFORE_KINECT_DEG if is_kinect else MAX_LEAN_DEG
    cosines = np.cos(np.radians([LYING_DEG, max_lean]))
    return up if cosines[0] < up[2] < cosines[1] and lacks_floor(recording) else None
