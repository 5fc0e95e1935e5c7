"""Estimate from a motion how its feet stand, if the rest pose does not show it."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..arrays import Array, Flags
from ..motion import Skeleton, WorldPoses
from ..motion.humanoid import SIDES, end_of_foot
from ..rotations import (
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
    rotation_vector_from_quaternion,
)
from ..signals import smooth_gaussian
from .body import HumanoidBody
from .placement import leg_length, rests_on_ground

SPEED_SMOOTHING_S = 0.05
"""Standard deviation of the Gaussian that smooths the angular velocity. Half and twice are no
better (`make sensitivity`)."""
STILL_QUANTILE = 0.5
"""Quantile, a fraction, of the angular speed in contact below which a foot is still. Half and
twice gain less than 1 % (`make sensitivity`)."""
MAX_ANKLE_DIFFERENCE_FRACTION = 0.02
"""Maximum height of an ankle above the mean of both, in leg lengths. Half and twice gain less
than 1 % (`make sensitivity`)."""
UPRIGHT_COSINE = np.cos(np.radians(30.0))
"""A foot with a larger tilt does not stand on its sole. Chosen by hand; `make sensitivity`
varies it."""
MAX_PITCH_RAD = np.radians(15.0)
"""Maximum pitch of a standing foot relative to the rest pose. Half and twice gain less than 1 %
(`make sensitivity`)."""
LATERAL_AXIS = np.array([1.0, 0.0, 0.0])
UP = np.array([0.0, 0.0, 1.0])


class Stance(NamedTuple):
    """Pitch and ankle height of a standing foot."""

    pitch: float
    """Downward pitch relative to the rest pose, radians."""
    ankle: float
    """Height of its ankle, meters."""


def find_stances(
    source: HumanoidBody,
    target: HumanoidBody,
    source_poses: WorldPoses,
    contacts: Flags | None,
    frame_rate: float,
) -> tuple[Stance, Stance] | None:
    """Return the stances of the source's feet, if only the motion shows them.

    A rig that rests on height 0 stands with level soles. Skeletons with their origin at the
    hips (Acclaim) have feet with arbitrary pitch: soles that are level in the source would
    slope on the target. For these, the flattest of the still, standing feet are used.
    """
    if contacts is None or rests_on_ground(source) or not rests_on_ground(target):
        return None
    stances = [
        _stance(source, source_poses, side, in_contact, frame_rate)
        for side, in_contact in zip(SIDES, contacts.T, strict=True)
    ]
    measured = [stance for stance in stances if stance]
    if not measured:
        return None
    pitch, ankle = np.mean(measured, axis=0)
    max_difference = MAX_ANKLE_DIFFERENCE_FRACTION * leg_length(source)
    left, right = (
        Stance(
            float(np.clip(one.pitch, -MAX_PITCH_RAD, MAX_PITCH_RAD)),
            float(np.clip(one.ankle, ankle - max_difference, ankle + max_difference)),
        )
        for one in (stance or Stance(pitch, ankle) for stance in stances)
    )
    return left, right


def with_level_soles(source: HumanoidBody, stances: tuple[Stance, Stance]) -> HumanoidBody:
    """Return the source with the alignment of its feet corrected to their stances."""
    alignment = source.alignment.copy()
    for side, stance in zip(SIDES, stances, strict=True):
        below = source.skeleton.subtree(source.joints[f"{side}Foot"])
        rotation = quaternion_from_rotation_vector(-stance.pitch * LATERAL_AXIS)
        alignment[below] = multiply(alignment[below], rotation)
    return replace(source, alignment=alignment)


def _stance(
    source: HumanoidBody,
    source_poses: WorldPoses,
    side: str,
    in_contact: Flags,
    frame_rate: float,
) -> Stance | None:
    foot, ball = foot_bone(source, side)
    bone = source.rest[ball] - source.rest[foot]
    rotations = source_poses.rotations[:, foot]
    upright = rotate(multiply(rotations, source.alignment[foot]), UP)[:, 2] > UPRIGHT_COSINE
    in_contact = in_contact & upright
    if not (bone.any() and in_contact.any()):
        return None
    speed = _angular_speed(rotations, frame_rate)
    still = in_contact & (speed <= np.quantile(speed[in_contact], STILL_QUANTILE))
    slopes = _slope(rotate(rotations[still], bone))
    flat = slopes <= np.median(slopes)
    ankle = np.median(source_poses.positions[still, foot, 2][flat])
    return Stance(float(np.median(slopes[flat]) - _slope(bone)), float(ankle))


def foot_bone(body: HumanoidBody, side: str) -> tuple[int, int]:
    """Return ankle and ball; without toes the end of the foot, or else the ankle again."""
    foot = body.joints[f"{side}Foot"]
    skeleton: Skeleton = body.skeleton
    toes = body.joints.get(f"{side}Toes")
    toes_index = toes if toes in skeleton.subtree(foot) else None
    return foot, end_of_foot(skeleton, foot, toes_index)


def _slope(vectors: Array) -> Array:
    """Return the downward slope of vectors, radians."""
    return np.asarray(np.arctan2(-vectors[..., 2], np.linalg.norm(vectors[..., :2], axis=-1)))


def _angular_speed(rotations: Array, frame_rate: float) -> Array:
    """Return the angular speed of rotations, shape (n_frames,), radians per second."""
    if len(rotations) < 2:
        return np.zeros(len(rotations))
    steps = rotation_vector_from_quaternion(multiply(rotations[1:], inverse(rotations[:-1])))
    steps = smooth_gaussian(steps * frame_rate, SPEED_SMOOTHING_S * frame_rate)
    speeds = np.linalg.norm(steps, axis=1)
    return np.asarray(np.maximum(np.append(speeds, 0.0), np.append(0.0, speeds)))
