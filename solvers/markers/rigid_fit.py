"""Fit a rigid shape to points in every frame."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
N_WEIGHTS = 8
STRAY, LEAST_STRAY = 3.0, 0.004
"""Times the usual distance from its place in the shape, and metres at least, from which on a
point counts less and less."""


def fit_rigidly(template: Array, places: Array) -> tuple[Array, Array]:
    """Return the turn and shift that bring a shape nearest to points (Kabsch 1976).

    Points far from their place count little (Cauchy weights, in turn with the fit), and those
    not seen count nothing. With fewer than three points the turn is not unique.

    Parameters
    ----------
    template : shape (n_points, 3), metres
    places : shape (n_frames, n_points, 3), metres

    Returns
    -------
    turns : shape (n_frames, 3, 3)
    shifts : shape (n_frames, 3), metres
        The template's origin in the world; NaN where nothing is seen.

    References
    ----------
    .. [1] Kabsch (1976). A solution for the best rotation to relate two sets of vectors.
       doi:10.1107/S0567739476001873
    """
    seen = np.isfinite(places).all(axis=-1)
    known = np.where(seen[..., None], places, 0.0)
    weights = seen.astype(float)
    turns, shifts = _weighted(template, known, weights)
    if len(template) > 3:
        for _ in range(N_WEIGHTS):
            off = np.linalg.norm(moved(template, turns, shifts) - known, axis=-1)
            usual = float(np.median(off[seen])) if seen.any() else 0.0
            stray = max(LEAST_STRAY, STRAY * usual)
            weights = seen / (1.0 + (np.nan_to_num(off) / stray) ** 2)
            turns, shifts = _weighted(template, known, weights)
    return turns, shifts


def moved(template: Array, turns: Array, shifts: Array) -> Array:
    """Return the shape in the world, shape (n_frames, n_points, 3)."""
    return np.asarray(np.einsum("fij,pj->fpi", turns, template) + shifts[:, None])


def _weighted(template: Array, places: Array, weights: Array) -> tuple[Array, Array]:
    total = weights.sum(axis=1)
    share = weights / np.where(total > 0.0, total, np.nan)[:, None]
    centre = np.nan_to_num(np.einsum("fp,fpi->fi", share, places))
    origin = np.nan_to_num(np.einsum("fp,pi->fi", share, template))
    arms = places - centre[:, None]
    shape = template - origin[:, None]
    spread = np.einsum("fp,fpi,fpj->fij", weights, arms, shape)
    left, _, right = np.linalg.svd(spread)
    left[:, :, 2] *= np.linalg.det(left @ right)[:, None]
    turns = left @ right
    shifts = centre - np.einsum("fij,fj->fi", turns, origin)
    return turns, np.where(total[:, None] > 0.0, shifts, np.nan)
