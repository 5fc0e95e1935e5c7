"""Initial poses from joint centers: the axes of every bone."""

from collections.abc import Mapping, Sequence

import numpy as np

from ..arrays import Array
from ..rotations import (
    matrix_from_quaternion,
    normalize,
    quaternion_from_matrix,
    quaternion_from_rotation_vector,
    rotation_vector_from_quaternion,
)
from .body_tables import MARKER_SIDES
from .joint_centers import JointCenters
from .vectors import frame, median_or_zero, swing_frames

MIN_FOOT_M = 0.05
"""Minimum distance between heel and toe markers. It guards a division where both labels are at
one place."""
MAX_SLOPE_SINE = 0.4
"""Maximum sine of the angle between the line of heel and toe markers and the sole. It guards
actors whose heels never reach the ground, and heights that no angle has."""


def bone_frames(
    centers: JointCenters, landmarks: Mapping[str, Array], names: Sequence[str]
) -> dict[str, Array]:
    """Return the axes of the bones named, each of shape (n_frames, 3, 3).

    Collar bones swing about their median direction. The spine gets half of the rotation from
    pelvis to thorax, the neck half of that from thorax to head.
    """
    frames = dict(centers.frames)
    if "chest" in frames:
        frames["spine"] = _halfway(frames["hips"], frames["chest"])
        frames["neck"] = _halfway(frames["chest"], frames.get("head", frames["chest"]))
    for side, (letter, sign) in MARKER_SIDES.items():
        _leg(centers, landmarks, frames, side, letter)
        if f"{side}UpperArm" in names:
            _arm(centers, landmarks, frames, side, letter, sign)
    return frames


def _halfway(start: Array, stop: Array) -> Array:
    """Return the rotations halfway between two."""
    rotation = quaternion_from_matrix(np.swapaxes(start, -1, -2) @ stop)
    half = quaternion_from_rotation_vector(0.5 * rotation_vector_from_quaternion(rotation))
    return np.asarray(start @ matrix_from_quaternion(half))


def _leg(
    centers: JointCenters,
    landmarks: Mapping[str, Array],
    frames: dict[str, Array],
    side: str,
    letter: str,
) -> None:
    hip, knee, ankle = (
        centers.positions[side + joint] for joint in ("UpperLeg", "LowerLeg", "Foot")
    )
    lateral = MARKER_SIDES[side][1] * (landmarks[f"{letter}KNE"] - knee)
    frames[f"{side}UpperLeg"] = frame(2, hip - knee, 0, lateral)
    frames[f"{side}LowerLeg"] = frame(2, knee - ankle, 0, lateral)
    if f"{letter}HEE" in landmarks:
        heel, toe = landmarks[f"{letter}HEE"], landmarks[f"{letter}TOE"]
        leveling = _leveling_matrix(heel, toe)
        frames[f"{side}Foot"] = (
            frame(0, frames[f"{side}LowerLeg"][..., 0], 1, heel - toe) @ leveling
        )


def _leveling_matrix(heel: Array, toe: Array) -> Array:
    """Return the rotation from the line between two markers to the level sole.

    The difference in height of heel and toe markers is measured where both are lowest.
    """
    low_heel, low_toe = (
        np.nanpercentile(marker[..., 2], 5.0) if np.isfinite(marker).any() else 0.0
        for marker in (heel, toe)
    )
    length = float(median_or_zero(np.linalg.norm(heel - toe, axis=-1)[:, None])[0])
    sine = np.clip(
        (low_heel - low_toe) / max(length, MIN_FOOT_M), -MAX_SLOPE_SINE, MAX_SLOPE_SINE
    )
    cosine = np.sqrt(1.0 - sine**2)
    return np.array([[1.0, 0.0, 0.0], [0.0, cosine, sine], [0.0, -sine, cosine]])


def _arm(
    centers: JointCenters,
    landmarks: Mapping[str, Array],
    frames: dict[str, Array],
    side: str,
    letter: str,
    sign: float,
) -> None:
    positions, thorax = centers.positions, frames["chest"]
    collar, shoulder, elbow = (
        positions[side + joint] for joint in ("Shoulder", "UpperArm", "LowerArm")
    )
    local = np.einsum("fji,fj->fi", thorax, shoulder - collar)
    frames[f"{side}Shoulder"] = swing_frames(
        thorax, normalize(median_or_zero(local)), shoulder - collar
    )
    upward = landmarks[f"{letter}ELB"] - elbow
    frames[f"{side}UpperArm"] = frame(0, sign * (elbow - shoulder), 2, upward)
    if f"{side}Hand" not in positions:
        return
    wrist = positions[f"{side}Hand"]
    back = landmarks[f"{letter}WRB"] - landmarks[f"{letter}WRA"]
    frames[f"{side}LowerArm"] = frame(0, sign * (wrist - elbow), 1, back)
    if f"{letter}FIN" in landmarks:
        knuckle = landmarks[f"{letter}FIN"]
        frames[f"{side}Hand"] = frame(0, sign * (knuckle - wrist), 1, back)
