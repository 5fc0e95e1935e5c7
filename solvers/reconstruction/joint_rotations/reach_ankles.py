"""Ankles come to where they were seen: the pelvis gives way, and knees bend for the rest."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ...motion import Motion, forward_kinematics
from ...motion.skeletons import ReachSettings, reach
from .limb_angles import unit_vectors
from .limb_twist import Limb, solve_smooth_paths

Array = NDArray[np.float64]

STRAIGHT_FLEXION, BENT_FLEXION = np.radians([20.0, 60.0])
"""Flexions of a knee up to which the pelvis gives way, and from which on the knee does."""
REST_WEIGHT = 0.1
"""Weight of a pelvis that stays; a straight and trusted leg has 1."""
SMOOTHING_S = 0.1
"""Seconds over which the pelvis gives way."""
SLACK_M = 0.008
"""Metres by which the ankle of a straight leg may be missed so that its knee does not shake."""


def pelvis_offsets(
    places: Array, reached: Array, trust: Array, legs: Sequence[Limb], frame_rate: float
) -> Array:
    """Return how far the pelvis must give way for stretched legs to fit, shape (n_frames, 3).

    A camera sees the way from hip to ankle some centimetres longer or shorter than it sees it
    mostly. A knee that is straight would have to move aside by 20 cm for 10 cm of that, the
    pelvis by 10 cm only. So the pelvis follows the legs, as far as they are straight and
    trusted, steadily (least squares); a bent knee takes the difference up at no such cost.

    Parameters
    ----------
    places, reached : shape (n_frames, n_joints, 3), metres
        Where joints were seen, and where those of aimed bones are.
    trust : shape (n_frames, n_joints), 0 to 1
    legs : sequence of Limb
    frame_rate : float, hertz
    """
    told, weights = np.zeros((len(places), 3)), np.zeros(len(places))
    for leg in legs:
        missed = places[:, leg.end] - reached[:, leg.end]
        weight = straightness(reached, leg) * trust[:, [leg.lower, leg.end]].min(axis=1)
        known = np.isfinite(missed).all(axis=-1) & np.isfinite(weight)
        weight = np.where(known, weight, 0.0)
        told += weight[:, None] * np.where(known[:, None], missed, 0.0)
        weights += weight
    return solve_smooth_paths(
        told, weights + REST_WEIGHT, (SMOOTHING_S * frame_rate) ** 2 * REST_WEIGHT
    )


def straightness(places: Array, limb: Limb) -> Array:
    """Return 1 where a limb is straight, 0 where it is bent, shape (n_frames,)."""
    first = unit_vectors(places[:, limb.lower] - places[:, limb.upper])
    second = unit_vectors(places[:, limb.end] - places[:, limb.lower])
    bend = np.arccos(np.clip(np.einsum("fi,fi->f", first, second), -1.0, 1.0))
    return np.asarray(
        np.clip((BENT_FLEXION - bend) / (BENT_FLEXION - STRAIGHT_FLEXION), 0.0, 1.0)
    )


def reach_ankles(motion: Motion, places: Array, legs: Mapping[int, Limb]) -> Motion:
    """Bend the knees of a motion until its ankles are where they were seen.

    Parameters
    ----------
    motion : Motion
        NaN where it is not known; such frames stay.
    places : shape (n_frames, n_joints, 3), metres
    legs : mapping of the upper joint to its limb
    """
    for leg in legs.values():
        reached = forward_kinematics(motion).positions
        start, end = reached[:, leg.upper], reached[:, leg.end]
        way = places[:, leg.end] - start
        length = np.linalg.norm(way, axis=-1)
        slack = SLACK_M * straightness(reached, leg)
        present = np.linalg.norm(end - start, axis=-1)
        wanted = length + np.clip(present - length, -slack, slack)
        target = start + way * (wanted / np.maximum(length, 1e-9))[:, None]
        chain = (leg.upper, leg.lower, leg.end)
        bent = reach(motion, chain, target, ReachSettings(softness=0.0)).rotations
        known = np.isfinite(bent).all(axis=-1)[..., None]
        motion = motion.with_poses(np.where(known, bent, motion.rotations))
    return motion
