"""The most probable posture, given some of its joints and the postures that are like it."""

import numpy as np
from numpy.typing import NDArray

from ...motion.humanoid import N_JOINTS
from ..pose_space import EnergyTargets, PostureSpaces

Array = NDArray[np.float64]

MODEL_ERROR_M = 0.1
"""Metres. How far a trusted joint may be from what its neighbours can say; chosen on
development clips. It is large because neighbours are few: their spread is not all there is."""
MIN_VARIANCE_M2 = 1e-8


def probable_postures(spaces: PostureSpaces, demands: EnergyTargets) -> tuple[Array, Array]:
    """Return postures, shape (n_frames, 20, 3), and each joint's deviation, (n_frames, 20).

    The neighbours are taken for a sample of a normal distribution in their space; the mean of
    that distribution, given what was seen, is a linear solve. In the place of the nearest
    neighbour in the style term of [SHJT13] stands the Mahalanobis distance.

    Parameters
    ----------
    spaces : PostureSpaces
    demands : Demands
    """
    told = np.isfinite(demands.observed).all(axis=-1)
    weights = np.repeat(np.where(told, demands.trust, 0.0), 3, axis=1)
    off = np.nan_to_num(demands.observed).reshape(weights.shape) - spaces.means
    turned = spaces.axes.swapaxes(-1, -2)
    H = turned @ (spaces.axes * weights[..., None])
    diagonal = np.arange(H.shape[-1])
    H[:, diagonal, diagonal] += MODEL_ERROR_M**2 / np.maximum(spaces.spreads, MIN_VARIANCE_M2)
    inverse = np.linalg.inv(H)
    z = inverse @ (turned @ (weights * off)[..., None])
    variances = MODEL_ERROR_M**2 * np.einsum("fid,fid->fi", spaces.axes @ inverse, spaces.axes)
    joints = variances.reshape(len(variances), N_JOINTS, 3).mean(axis=-1)
    return spaces.postures(z[..., 0]), np.sqrt(joints)
