"""Quaternions of rotation matrices; SciPy's order x y z w is confined to this module."""

import numpy as np

from ..arrays import Array

MAX_SKEW = 1e-5
"""Difference, relative to 1, of a matrix times its transpose from identity up to which it is a
rotation; guards against scaled ones, and passes matrices of 32 bits."""


def quaternions_of_matrices(matrices: Array) -> Array:
    """Return quaternions of matrices, shape (n, 3, 3); SciPy's of those that are no rotations.

    Of four formulas for the quaternion, the one whose divisor is largest (Shepperd 1978).
    """
    products = matrices @ np.swapaxes(matrices, -1, -2)
    if np.abs(products - np.eye(3)).max() > MAX_SKEW or (np.linalg.det(matrices) < 0.0).any():
        from scipy.spatial.transform import Rotation  # slow to import: only when needed

        found = Rotation.from_matrix(matrices)
        return np.roll(np.asarray(found.as_quat(canonical=True)), 1, axis=-1)
    xx, yy, zz = np.diagonal(matrices, axis1=-2, axis2=-1).T
    difference = matrices - np.swapaxes(matrices, -1, -2)
    total = matrices + np.swapaxes(matrices, -1, -2)
    wx, wy, wz = difference[:, 2, 1], difference[:, 0, 2], difference[:, 1, 0]
    xy, xz, yz = total[:, 0, 1], total[:, 0, 2], total[:, 1, 2]
    divisors = np.array([
        1 + xx + yy + zz,
        1 + xx - yy - zz,
        1 - xx + yy - zz,
        1 - xx - yy + zz,
    ])
    choices = np.array([
        [divisors[0], wx, wy, wz],
        [wx, divisors[1], xy, xz],
        [wy, xy, divisors[2], yz],
        [wz, xz, yz, divisors[3]],
    ])
    best = choices[divisors.argmax(axis=0), :, np.arange(len(matrices))]
    best *= np.where(best[:, :1] < 0.0, -1.0, 1.0)
    return np.asarray(best / np.linalg.norm(best, axis=-1, keepdims=True))
