"""Ways to fill gaps: (gapped (n_frames, n_channels), NaN = missing, frame rate) -> no NaN.

Where a channel is never seen, the methods that look at one channel leave NaN: there is nothing
they could say.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline, PchipInterpolator

from solvers.arrays import Array

ENOUGH_SEEN = 2


def linear(gapped: Array, frame_rate: float) -> Array:
    """Straight lines; the last seen value beyond the ends."""
    frames = np.arange(len(gapped))
    return _each(gapped, lambda seen, values: np.interp(frames, seen, values))


def pchip(gapped: Array, frame_rate: float) -> Array:
    """Monotone cubic pieces, as the MoCap Toolbox fills."""
    return _each(gapped, lambda seen, values: _inside(gapped, seen, values, PchipInterpolator))


def cubic(gapped: Array, frame_rate: float) -> Array:
    """Cubic spline through everything seen."""
    return _each(gapped, lambda seen, values: _inside(gapped, seen, values, CubicSpline))


def soft_impute(gapped: Array, frame_rate: float, shrink: float) -> Array:
    """Low-rank completion of the matrix of frames by channels (Mazumder et al. 2010).

    `shrink` is the last threshold on singular values, as a fraction of the largest; as in the
    paper, it is reached from larger ones.
    """
    seen = np.isfinite(gapped)
    mean = np.nanmean(np.where(seen.any(axis=0), gapped, 0.0), axis=0)
    given = np.where(seen, gapped - mean, 0.0)
    filled = np.where(seen, given, linear(gapped, frame_rate) - mean)
    filled = np.nan_to_num(filled)
    for level in np.repeat(np.geomspace(0.5, shrink, 15), 5):
        # The right singular vectors from the small Gram matrix: takes are tall.
        squares, V = np.linalg.eigh(filled.T @ filled)
        singular = np.sqrt(np.maximum(squares, 1e-12))
        kept = np.maximum(1.0 - level * singular[-1] / singular, 0.0)
        filled = np.where(seen, given, filled @ (V * kept) @ V.T)
    return np.where(seen, gapped, filled + mean)


def conditional_pose(gapped: Array, frame_rate: float, training: Sequence[Array]) -> Array:
    """Expected values of the missing channels of each pose, given its seen ones.

    A Gaussian over poses, learned from the training clips; time plays no part.
    """
    frames = np.concatenate(training)
    mean, covariance = frames.mean(axis=0), np.cov(frames.T)
    covariance += 1e-2 * np.mean(np.diag(covariance)) * np.eye(len(mean))
    result = gapped.copy()
    patterns, which = np.unique(np.isfinite(gapped), axis=0, return_inverse=True)
    for number, seen in enumerate(patterns):
        if seen.all():
            continue
        rows = np.flatnonzero(which.ravel() == number)
        known = gapped[np.ix_(rows, seen)] - mean[seen]
        weights = np.linalg.solve(
            covariance[np.ix_(seen, seen)], covariance[np.ix_(seen, ~seen)]
        )
        result[np.ix_(rows, ~seen)] = mean[~seen] + known @ weights
    return result


def _each(gapped: Array, fill) -> Array:
    result = gapped.copy()
    for channel, values in enumerate(gapped.T):
        seen = np.flatnonzero(np.isfinite(values))
        if ENOUGH_SEEN <= len(seen) < len(values):
            gaps = ~np.isfinite(values)
            result[gaps, channel] = fill(seen, values[seen])[gaps]
    return result


def _inside(gapped: Array, seen: NDArray[np.intp], values: Array, curve) -> Array:
    """Interpolate between the first and last seen frame; hold the values beyond."""
    frames = np.clip(np.arange(len(gapped)), seen[0], seen[-1])
    return np.asarray(curve(seen, values)(frames))
