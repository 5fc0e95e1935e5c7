"""Fit a rigid shape to points in every frame."""

import numpy as np

from ..arrays import Array
from ..rotations import nearest_rotations

N_REWEIGHTINGS = 8
"""Iterations of the reweighted least squares. It guards fits with an outlier, which a single
fit follows (`test_outlier_marker_is_corrected_and_hardly_moves_others`)."""
MARKER_NOISE_M = 0.004
"""Meters by which a marker may be off its place on a body: skin moves by millimeters. It guards
what is exact for most of a take, such as the distances of two markers, the steps of a pair, or
a rod: every deviation would be significant."""
CAUCHY_FACTOR = 3.0
"""Scale of the Cauchy weights, a multiple of the median residual. It guards fits with an
outlier, which equal weights follow (`test_rigid`)."""


def fit_rigid_transform(template: Array, positions: Array) -> tuple[Array, Array]:
    """Return the rotation and translation that fit a shape to points (Kabsch 1976).

    Cauchy weights, alternating with the fit, limit the influence of outliers; missing points
    have no weight. With fewer than three points the rotation is not unique.

    Parameters
    ----------
    template : shape (n_points, 3), meters
    positions : shape (n_frames, n_points, 3), meters

    Returns
    -------
    rotations : shape (n_frames, 3, 3)
    translations : shape (n_frames, 3), meters
        The template's origin in the world; NaN without observed points.

    References
    ----------
    .. [1] Kabsch (1976). A solution for the best rotation to relate two sets of vectors.
       doi:10.1107/S0567739476001873
    """
    observed = np.isfinite(positions).all(axis=-1)
    filled = np.where(observed[..., None], positions, 0.0)
    weights = observed.astype(float)
    rotations, translations = _fit_weighted(template, filled, weights)
    if len(template) > 3:
        for _ in range(N_REWEIGHTINGS):
            distances = np.linalg.norm(
                transform_shape(template, rotations, translations) - filled, axis=-1
            )
            typical = float(np.median(distances[observed])) if observed.any() else 0.0
            scale = max(MARKER_NOISE_M, CAUCHY_FACTOR * typical)
            weights = observed / (1.0 + (np.nan_to_num(distances) / scale) ** 2)
            rotations, translations = _fit_weighted(template, filled, weights)
    return rotations, translations


def transform_shape(template: Array, rotations: Array, translations: Array) -> Array:
    """Return the shape in world space, shape (n_frames, n_points, 3)."""
    return np.asarray(np.einsum("fij,pj->fpi", rotations, template) + translations[:, None])


def _fit_weighted(template: Array, positions: Array, weights: Array) -> tuple[Array, Array]:
    total = weights.sum(axis=1)
    fraction = weights / np.where(total > 0.0, total, np.nan)[:, None]
    center = np.nan_to_num(np.einsum("fp,fpi->fi", fraction, positions))
    origin = np.nan_to_num(np.einsum("fp,pi->fi", fraction, template))
    arms = positions - center[:, None]
    shape = template - origin[:, None]
    spread = np.einsum("fp,fpi,fpj->fij", weights, arms, shape)
    rotations, _ = nearest_rotations(spread)
    translations = center - np.einsum("fij,fj->fi", rotations, origin)
    return rotations, np.where(total[:, None] > 0.0, translations, np.nan)
