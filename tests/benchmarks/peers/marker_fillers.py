"""Published methods to fill gaps of optical markers; PMA-R2 after reading its authors' program.

(gapped (n_frames, n_markers, 3) meters, NaN = missing, frame rate) -> the same without NaN.
"""

from collections.abc import Callable

import numpy as np

from solvers.arrays import Array

from . import gap_fillers
from .kalman import Dynamics, smooth

WEIGHT_SCALE = 0.2
MISSING_WEIGHT = 0.02
DISTAL = 0.5
KEPT_ENERGY = 0.99
SUBSPACE_ENERGY = 0.9999
CONTEXT_S = 1.0
"""Seconds on both sides of a gap that the subspace Kalman smoother sees."""


def each_coordinate(filler: Callable[[Array, float], Array]) -> Callable[[Array, float], Array]:
    """Return a filler of markers from one of channels."""

    def fill(gapped: Array, frame_rate: float) -> Array:
        return filler(gapped.reshape(len(gapped), -1), frame_rate).reshape(gapped.shape)

    return fill


def centered(filler: Callable[[Array, float], Array]) -> Callable[[Array, float], Array]:
    """Return the filler working relative to the mean of the markers that are never missing."""

    def fill(gapped: Array, frame_rate: float) -> Array:
        center = center_of(gapped)
        return filler(gapped - center, frame_rate) + center

    return fill


def center_of(gapped: Array) -> Array:
    """Mean of the markers that are never missing, shape (n_frames, 1, 3)."""
    complete = np.isfinite(gapped).all(axis=(0, 2))
    return np.asarray(gapped[:, complete].mean(axis=1, keepdims=True))


def soft_impute(gapped: Array, frame_rate: float) -> Array:
    """Low-rank completion with a weak threshold."""
    return each_coordinate(lambda flat, rate: gap_fillers.soft_impute(flat, rate, 0.003))(
        gapped, frame_rate
    )


def principal_markers(gapped: Array, frame_rate: float) -> Array:
    """PMA-R2: weighted principal components of the nearby markers.

    Gløersen and Federolf (2016), doi:10.1371/journal.pone.0152616, with the parameters given
    there. Works relative to the mean marker; see `centered`.
    """
    filled = gapped.copy()
    missing = np.isnan(gapped).any(axis=2)
    for marker in np.flatnonzero(missing.any(axis=0)):
        distances = np.linalg.norm(gapped - gapped[:, [marker]], axis=2)
        distance = np.nanmean(distances, axis=0)
        overlapping = (missing & missing[:, [marker]]).any(axis=0)
        distal = missing.any(axis=0) & (distance > DISTAL * distance.mean())
        dropped = (overlapping | distal) & (np.arange(len(distance)) != marker)
        data = np.where(dropped[None, :, None], 0.0, gapped)
        rows = missing[:, marker]
        complete = ~np.isnan(data).any(axis=(1, 2))
        weights = np.exp(-(distance**2) / (2 * WEIGHT_SCALE**2))
        weights[marker] = MISSING_WEIGHT
        filled[rows, marker] = _from_components(data[complete], data[rows], marker, weights)
    return filled


def _from_components(training: Array, query: Array, marker: int, weights: Array) -> Array:
    columns = slice(3 * marker, 3 * marker + 3)
    train, query = training.reshape(len(training), -1), query.reshape(len(query), -1)
    mean, deviation = train.mean(axis=0), train.std(axis=0)
    weight = np.repeat(weights, 3) / np.where(deviation > 0, deviation, 1.0)
    N, N0, M0 = ((each - mean) * weight for each in (train, train, query))
    N0[:, columns] = 0.0
    M0[:, columns] = 0.0
    V, V0 = _components(N), _components(N0)
    n_components = max(V[1], V0[1])
    full, without = V[0][:, :n_components], V0[0][:, :n_components]
    estimate = M0 @ without @ (full.T @ without) @ full.T
    return np.asarray(mean[columns] + estimate[:, columns] / weight[columns])


def _components(data: Array) -> tuple[Array, int]:
    values, vectors = np.linalg.eigh(data.T @ data)
    singular = np.sqrt(np.maximum(values[::-1], 0.0))
    energy = np.cumsum(singular) / singular.sum()
    return vectors[:, ::-1], int(np.argmax(energy >= KEPT_ENERGY)) + 1


def subspace_kalman(gapped: Array, frame_rate: float) -> Array:
    """Kalman smoothing of principal-component weights that walk at random.

    Burke and Lasenby (2016), doi:10.1016/j.jbiomech.2016.04.016.
    """
    filled = gapped.reshape(len(gapped), -1).copy()
    observed = np.isfinite(filled)
    complete = filled[observed.all(axis=1)]
    mean = complete.mean(axis=0)
    values, vectors = np.linalg.eigh(np.cov(complete.T))
    n_components = int(np.argmax(np.cumsum(values[::-1]) >= SUBSPACE_ENERGY * values.sum())) + 1
    V = vectors[:, ::-1][:, :n_components]
    scores = (complete - mean) @ V
    steps = np.diff(scores, axis=0)
    rest = max(float(values[:-n_components].mean()), 1e-8)
    dynamics = Dynamics(
        np.eye(n_components),
        np.diag((steps**2).mean(axis=0)),
        V,
        rest * np.eye(len(mean)),
        np.zeros(n_components),
        np.zeros(n_components),
        np.diag(scores.var(axis=0)),
    )
    rows = np.flatnonzero(~observed.all(axis=1))
    margin = round(CONTEXT_S * frame_rate)
    part = slice(max(rows[0] - margin, 0), rows[-1] + margin + 1)
    estimate = smooth(dynamics, filled[part] - mean) @ V.T + mean
    filled[part] = np.where(observed[part], filled[part], estimate)
    return filled.reshape(gapped.shape)
