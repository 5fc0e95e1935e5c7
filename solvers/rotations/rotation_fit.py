"""Fit rotations and similarities between sets of vectors by least squares."""

import numpy as np

from ..arrays import Array
from .representations import quaternion_from_matrix

RIGID_POINTS = 3
"""Number of points that determine rotation and position of a rigid body, by definition."""
MIN_SINGULAR_RATIO = 1e-4
"""Ratio of the second to the first singular value below which the rotation is undetermined. It
guards points on one line, whose second value is rounding of positions in single precision."""


def nearest_rotations(spread: Array) -> tuple[Array, Array]:
    """Return the rotations nearest to matrices [1]_, without reflections.

    Parameters
    ----------
    spread : shape (..., 3, 3)
        The weighted sum of y x^T over pairs of vectors: the rotation maps x closest to y.

    Returns
    -------
    rotations : shape (..., 3, 3)
    sizes : shape (..., 3)
        Singular values; the last is negative where the nearest matrix is a reflection.

    References
    ----------
    .. [1] Kabsch (1976). A solution for the best rotation to relate two sets of vectors. Acta
       Crystallographica A32. doi:10.1107/S0567739476001873
    """
    left, sizes, right = np.linalg.svd(spread)
    signs = np.ones_like(sizes)
    signs[..., 2] = np.sign(np.linalg.det(left) * np.linalg.det(right))
    return np.asarray((left * signs[..., None, :]) @ right), np.asarray(sizes * signs)


def fit_similarity(source: Array, target: Array) -> tuple[Array, float, Array]:
    """Return rotation, scale and translation that map points, shape (n, 3), closest to others.

    Umeyama (1991), doi:10.1109/34.88573.
    """
    centroids = source.mean(axis=0), target.mean(axis=0)
    first, second = source - centroids[0], target - centroids[1]
    rotation, sizes = nearest_rotations(second.T @ first)
    scale = float(sizes.sum() / max((first**2).sum(), np.finfo(float).tiny))
    return rotation, scale, centroids[1] - scale * rotation @ centroids[0]


def fit_rotations(shape: Array, observed: Array) -> Array:
    """Return the rotations R for which R `shape` is nearest to `observed` in each frame.

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
    spread = np.einsum("pi,fpj->fij", shape, np.where(valid, observed, 0.0))
    inverse_rotations, sizes = nearest_rotations(spread)
    rotations = quaternion_from_matrix(np.swapaxes(inverse_rotations, 1, 2))
    determined = sizes[:, 1] > MIN_SINGULAR_RATIO * np.maximum(
        sizes[:, 0], np.finfo(float).tiny
    )
    return np.where(determined[:, None], rotations, np.nan)
