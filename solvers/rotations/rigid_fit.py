"""Fit rotations between sets of vectors by least squares (Kabsch)."""

import numpy as np
from numpy.typing import NDArray

from .representations import quaternion_from_matrix

Array = NDArray[np.float64]
MIN_SINGULAR_RATIO = 1e-4
"""Ratio of the second to the first singular value below which the rotation is undetermined."""


def fit_rotations(shape: Array, observed: Array) -> Array:
    """Return the rotations R for which R `shape` is nearest to `observed` in each frame.

    The least-squares solution by singular value decomposition (Kabsch 1976,
    doi:10.1107/S0567739476001873), without reflections.

    Parameters
    ----------
    shape : shape (n_points, 3)
        Vectors before the rotation.
    observed : shape (n_frames, n_points, 3)
        Vectors after the rotation; points with NaN are left out of their frame.

    Returns
    -------
    NDArray, shape (n_frames, 4)
        Unit quaternions w x y z; NaN where fewer than two directions are observed.
    """
    valid = np.isfinite(observed).all(axis=-1, keepdims=True)
    covariance = np.einsum("pi,fpj->fij", shape, np.where(valid, observed, 0.0))
    left, singular_values, right = np.linalg.svd(covariance)
    reflection = np.sign(np.linalg.det(left) * np.linalg.det(right))
    right[:, 2] *= reflection[:, None]
    rotations = quaternion_from_matrix(np.swapaxes(left @ right, 1, 2))
    determined = singular_values[:, 1] > MIN_SINGULAR_RATIO * np.maximum(
        singular_values[:, 0], np.finfo(float).tiny
    )
    return np.where(determined[:, None], rotations, np.nan)
