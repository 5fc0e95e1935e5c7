"""How far joints of postures are off, and how jerky they move."""

import numpy as np

from solvers.arrays import Array
from solvers.motion.humanoid.posture_joints import N_JOINTS, PARENTS

from .kinect_pairs import Pair

ABOVE = np.maximum(PARENTS, 0)


def compared(made: Array, truth: Array) -> tuple[Array, Array, Array]:
    """Return errors of all kinds, each of shape (n_frames, 20)."""
    off = made - truth
    between = off - off[:, ABOVE]
    between[:, 0] = np.nan
    is_known = np.isfinite(off).any(axis=(0, 2))
    mean_error = np.zeros((N_JOINTS, 3))
    mean_error[is_known] = np.nanmean(off[:, is_known], axis=0)
    absolute, relative, free = (
        np.linalg.norm(one, axis=-1) for one in (off, between, off - mean_error)
    )
    return absolute, relative, free


def bone_direction_errors(made: Array, truth: Array) -> Array:
    """Return errors of the vector from the parent joint, less their means, (n_frames, 20)."""
    off = made - truth
    between = off - off[:, ABOVE]
    between[:, 0] = np.nan
    is_known = np.isfinite(between).any(axis=(0, 2))
    between[:, is_known] -= np.nanmean(between[:, is_known], axis=0)
    return np.asarray(np.linalg.norm(between, axis=-1))


def jerk(made: Array, pair: Pair) -> Array:
    """Sizes of the third differences, m/s³."""
    third = np.diff(made, 3, axis=0) * pair.kinect.frame_rate**3
    return np.asarray(np.linalg.norm(third, axis=-1))
