"""Offset the pelvis and flex the knees so that ankles reach their observed positions."""

from collections.abc import Mapping, Sequence

import numpy as np

from ...arrays import Array
from ...motion import Motion, forward_kinematics
from ...motion.skeletons import ReachSettings, reach
from .limb_angles import unit_vectors
from .limb_twist import Limb, solve_smooth_paths

STRAIGHT_FLEXION, BENT_FLEXION = np.radians([20.0, 60.0])
"""Knee flexion (radians) up to which the pelvis is offset, and from which the knee flexes."""
REST_WEIGHT = 0.1
"""Weight of zero pelvis offset; a straight and reliable leg has weight 1. Chosen by hand: x0.5
costs 0.2 %, x2 gains 0.1 %."""
SMOOTHING_S = 0.1
"""Time (s) over which the pelvis offset is smoothed. Chosen by hand: x0.5 and x2 change the
mean by less than 0.1 %."""
SLACK_M = 0.008
"""Distance (m) by which the ankle of a straight leg may miss its target, to avoid knee jitter.
Chosen by hand: x0.5 and x2 change the mean by less than 0.1 %."""


def pelvis_offsets(
    positions: Array,
    reached: Array,
    reliability: Array,
    legs: Sequence[Limb],
    frame_rate: float,
) -> Array:
    """Return the pelvis offset that lets straight legs reach the ankles, (n_frames, 3).

    A camera observes the distance from hip to ankle with errors of some centimeters. For an
    error of 10 cm, a straight knee would move sideways by 20 cm, the pelvis only by 10 cm. So
    the pelvis follows straight and reliable legs, smoothed by least squares; a flexed knee
    absorbs the difference without that cost.

    Parameters
    ----------
    positions, reached : shape (n_frames, n_joints, 3), meters
        Observed joints, and joints of the aimed bones.
    reliability : shape (n_frames, n_joints), 0 to 1
    legs : sequence of Limb
    frame_rate : float, hertz
    """
    weighted_errors, weights = np.zeros((len(positions), 3)), np.zeros(len(positions))
    for leg in legs:
        errors = positions[:, leg.end] - reached[:, leg.end]
        weight = straightness(reached, leg) * reliability[:, [leg.lower, leg.end]].min(axis=1)
        is_known = np.isfinite(errors).all(axis=-1) & np.isfinite(weight)
        weight = np.where(is_known, weight, 0.0)
        weighted_errors += weight[:, None] * np.where(is_known[:, None], errors, 0.0)
        weights += weight
    return solve_smooth_paths(
        weighted_errors, weights + REST_WEIGHT, (SMOOTHING_S * frame_rate) ** 2 * REST_WEIGHT
    )


def straightness(positions: Array, limb: Limb) -> Array:
    """Return 1 where a limb is straight, 0 where it is flexed, shape (n_frames,)."""
    first = unit_vectors(positions[:, limb.lower] - positions[:, limb.upper])
    second = unit_vectors(positions[:, limb.end] - positions[:, limb.lower])
    flexion = np.arccos(np.clip(np.einsum("fi,fi->f", first, second), -1.0, 1.0))
    return np.asarray(
        np.clip((BENT_FLEXION - flexion) / (BENT_FLEXION - STRAIGHT_FLEXION), 0.0, 1.0)
    )


def reach_ankles(motion: Motion, positions: Array, legs: Mapping[int, Limb]) -> Motion:
    """Flex the knees of a motion until its ankles reach their observed positions.

    Parameters
    ----------
    motion : Motion
        NaN where unknown; such frames stay unchanged.
    positions : shape (n_frames, n_joints, 3), meters
    legs : mapping of the upper joint to its limb
    """
    for leg in legs.values():
        reached = forward_kinematics(motion).positions
        start, end = reached[:, leg.upper], reached[:, leg.end]
        direction = positions[:, leg.end] - start
        length = np.linalg.norm(direction, axis=-1)
        slack = SLACK_M * straightness(reached, leg)
        current_length = np.linalg.norm(end - start, axis=-1)
        target_length = length + np.clip(current_length - length, -slack, slack)
        target = start + direction * (target_length / np.maximum(length, 1e-9))[:, None]
        chain = (leg.upper, leg.lower, leg.end)
        rotations = reach(motion, chain, target, ReachSettings(softness=0.0)).rotations
        is_known = np.isfinite(rotations).all(axis=-1)[..., None]
        motion = motion.with_poses(np.where(is_known, rotations, motion.rotations))
    return motion
