"""Move the hips a little where a leg would be too short for its footplant."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...motion import Skeleton, WorldPoses
from ...signals import smooth_correction
from .foot_trajectory import Plant

Array = NDArray[np.float64]

N_ROUNDS = 30
CLOSE_ENOUGH = 5e-4
SLOWER = 2.0
"""The body is heavier than a foot: its shift fades over this many times the blend."""


def root_shift(
    skeleton: Skeleton,
    poses: WorldPoses,
    plants: Sequence[Plant],
    frame_rate: float,
    *,
    softness: float,
    blend: float,
) -> Array:
    """Return a smooth shift of the root, (n_frames, 3), that lets the legs reach their plants.

    Each round asks, in the frames in contact where a leg is still too short, for what is
    missing along the leg, and joins all that was asked for so far with the smoothest curve
    (the method of multipliers on `smooth_correction`).

    Parameters
    ----------
    skeleton : Skeleton
    poses : WorldPoses
    plants : sequence of Plant
    frame_rate : float, hertz
    softness : float
        Part of a leg's length that it does not use, unless its pose already does.
    blend : float, seconds
        Time over which a foot's correction fades.
    """
    n_frames = len(poses.positions)
    shift, goal = np.zeros((n_frames, 3)), np.zeros((n_frames, 3))
    still = np.zeros((n_frames - 1, 3)), np.zeros(n_frames - 1)
    for _ in range(N_ROUNDS):
        missing = np.zeros((n_frames, 3))
        for plant in plants:
            lacking = _missing(skeleton, poses, plant, shift, softness)
            missing = np.where(np.abs(lacking) > np.abs(missing), lacking, missing)
        if np.linalg.norm(missing, axis=1).max() < CLOSE_ENOUGH:
            break
        goal = np.where(missing.any(axis=1)[:, None], shift + missing, goal)
        asked = np.repeat(goal.any(axis=1)[:, None], 3, axis=1).astype(np.float64)
        shift = smooth_correction(*still, frame_rate, SLOWER * blend, goal=goal, pulled=asked)
    return shift


def _missing(
    skeleton: Skeleton, poses: WorldPoses, plant: Plant, shift: Array, softness: float
) -> Array:
    """Return how far, and in which direction, the root must come nearer to the foot."""
    hip, knee, ankle = (poses.positions[:, joint] for joint in plant.leg.chain)
    longest = np.linalg.norm(knee - hip, axis=1) + np.linalg.norm(ankle - knee, axis=1)
    usable = np.maximum((1.0 - softness) * longest, np.linalg.norm(ankle - hip, axis=1))
    way = plant.ankle - hip - shift
    distance = np.linalg.norm(way, axis=1)
    lacking = np.where(plant.contact, np.maximum(distance - usable, 0.0), 0.0)
    return np.asarray(way * (lacking / np.maximum(distance, 1e-9))[:, None])
