"""The turn that brings one set of directions nearest to another."""

import numpy as np
from numpy.typing import NDArray

from .representations import quaternion_from_matrix

Array = NDArray[np.float64]
MIN_SINGULAR_RATIO = 1e-4
"""Where all but one singular value are smaller than this part of it, the turn is not told."""


def fit_rotations(shape: Array, seen: Array) -> Array:
    """Return the turns R for which R `shape` is nearest to what was `seen`, frame by frame.

    The solution in least squares by singular values (Kabsch 1976,
    doi:10.1107/S0567739476001873), without mirroring.

    Parameters
    ----------
    shape : shape (n_points, 3)
        Vectors as they are before the turn.
    seen : shape (n_frames, n_points, 3)
        The same after it; points with NaN are left out of their frame.

    Returns
    -------
    NDArray, shape (n_frames, 4)
        Unit quaternions w x y z; NaN where fewer than two directions were seen.
    """
    known = np.isfinite(seen).all(axis=-1, keepdims=True)
    covariance = np.einsum("pi,fpj->fij", shape, np.where(known, seen, 0.0))
    left, sizes, right = np.linalg.svd(covariance)
    mirrored = np.sign(np.linalg.det(left) * np.linalg.det(right))
    right[:, 2] *= mirrored[:, None]
    turns = quaternion_from_matrix(np.swapaxes(left @ right, 1, 2))
    told = sizes[:, 1] > MIN_SINGULAR_RATIO * np.maximum(sizes[:, 0], np.finfo(float).tiny)
    return np.where(told[:, None], turns, np.nan)
