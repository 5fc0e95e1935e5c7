"""The most probable pose, given some of its joints and similar library poses."""

import numpy as np

from ...arrays import Array
from ...motion.humanoid import N_JOINTS
from ..pose_space import MIN_VARIANCE_M2, EnergyTargets, PostureSpaces

MODEL_ERROR_M = 0.1
"""Standard deviation (m) of a reliable joint about the space of its neighbors; chosen on
development clips. It is large because few neighbors underestimate the variance. Half and twice
are no better (`make sensitivity`)."""


def probable_postures(spaces: PostureSpaces, targets: EnergyTargets) -> tuple[Array, Array]:
    """Return poses, (n_frames, 20, 3), and the standard deviation per joint, (n_frames, 20).

    The neighbors are samples of a normal distribution in their space. The mean of that
    distribution, given the observed joints, is the solution of a linear system. The Mahalanobis
    distance replaces the distance to the nearest neighbor in the style term of [SHJT13].

    Parameters
    ----------
    spaces : PostureSpaces
    targets : EnergyTargets
    """
    is_observed = np.isfinite(targets.observed).all(axis=-1)
    weights = np.repeat(np.where(is_observed, targets.reliability, 0.0), 3, axis=1)
    residuals = np.nan_to_num(targets.observed).reshape(weights.shape) - spaces.means
    transposed = spaces.axes.swapaxes(-1, -2)
    H = transposed @ (spaces.axes * weights[..., None])
    diagonal = np.arange(H.shape[-1])
    H[:, diagonal, diagonal] += MODEL_ERROR_M**2 / np.maximum(spaces.spreads, MIN_VARIANCE_M2)
    inverse = np.linalg.inv(H)
    z = inverse @ (transposed @ (weights * residuals)[..., None])
    variances = MODEL_ERROR_M**2 * np.einsum("fid,fid->fi", spaces.axes @ inverse, spaces.axes)
    joints = variances.reshape(len(variances), N_JOINTS, 3).mean(axis=-1)
    return spaces.postures(z[..., 0]), np.sqrt(joints)
