"""Lay the toes of standing feet down where no camera saw them."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ..denoising.feet import SIDES, Leg, find_legs
from ..motion import Motion, WorldPoses, forward_kinematics
from ..rotations import IDENTITY, inverse, multiply, rotate, rotation_between, slerp

Array = NDArray[np.float64]

DOUBTED, LOST = 0.8, 0.5
"""Reliability up to which toes are laid down, and below which wholly; those that a tracker
inferred have at most the second."""
TOO_HIGH = 0.03
"""Metres above their ankle at which the toes of a standing foot are wrong."""
DROP = 0.35
"""How far toes lie below their ankle, in lengths of the foot, where no frame tells it."""
FEWEST = 10
"""Frames that tell how a foot stands."""
EASE, STEADY = 0.05, 0.5
"""Seconds."""
AHEAD = 0.2
"""Least part of a way that must be level for it to tell a heading."""


def level_toes(motion: Motion, reliability: Array, contacts: NDArray[np.bool_]) -> Motion:
    """Turn standing feet whose toes are lost, or above the ankle, so that they stand flat.

    They point where the shin says: as toes that were seen lie about it, or as in the rest pose.
    How far below the ankle they lie is the median of when they were seen to stand.

    Parameters
    ----------
    motion : Motion
    reliability : shape (n_frames, n_joints), 0 to 1
        NaN: trusted.
    contacts : bool, shape (n_frames, 2), left and right
        When each foot stands.
    """
    poses = forward_kinematics(motion)
    rotations = motion.rotations.copy()
    for leg in find_legs(motion.skeleton):
        standing = contacts[:, SIDES.index(leg.side)]
        if leg.toe is None or not standing.any():
            continue
        way = poses.positions[:, leg.toe] - poses.positions[:, leg.ankle]
        trust = np.nan_to_num(reliability[:, leg.toe], nan=1.0)
        wrong = np.clip((DOUBTED - trust) / (DOUBTED - LOST), 0.0, 1.0)
        wrong = np.maximum(wrong, np.clip(way[:, 2] / TOO_HIGH, 0.0, 1.0))
        wanted = _level_way(motion, poses, leg, way, standing & (wrong == 0.0))
        told = np.isfinite(wanted).all(axis=-1)
        share = np.where(told, wrong * standing, 0.0)
        share = gaussian_filter1d(share, EASE * motion.frame_rate, mode="nearest")
        swing = rotation_between(way, np.where(told[:, None], wanted, way))
        turn = slerp(np.broadcast_to(IDENTITY, swing.shape), swing, share)
        above = poses.rotations[:, motion.skeleton.parents[leg.ankle]]
        world = multiply(turn, poses.rotations[:, leg.ankle])
        changed = multiply(inverse(above), world)
        rotations[:, leg.ankle] = np.where(
            share[:, None] > 0.0, changed, rotations[:, leg.ankle]
        )
    return motion.with_poses(rotations)


def _level_way(
    motion: Motion, poses: WorldPoses, leg: Leg, way: Array, sure: NDArray[np.bool_]
) -> Array:
    """Return the way to the toes of a foot that stands flat; NaN where no heading is told."""
    shin = poses.rotations[:, leg.knee]
    rest = motion.skeleton.rest_positions
    length = float(np.linalg.norm(rest[leg.toe] - rest[leg.ankle]))
    local, drop = rest[leg.toe] - rest[leg.ankle], DROP * length
    if sure.sum() >= FEWEST:
        local = np.median(rotate(inverse(shin[sure]), way[sure]), axis=0)
        drop = float(np.clip(np.median(-way[sure, 2]), 0.0, 0.7 * length))
    ahead = rotate(shin, local)[:, :2]
    ahead = gaussian_filter1d(ahead, STEADY * motion.frame_rate, axis=0, mode="nearest")
    size = np.linalg.norm(ahead, axis=-1, keepdims=True)
    ahead = np.where(size > AHEAD * length, ahead / np.maximum(size, 1e-9), np.nan)
    level = np.sqrt(length**2 - drop**2)
    return np.concatenate([level * ahead, np.full((len(way), 1), -drop)], axis=-1)
