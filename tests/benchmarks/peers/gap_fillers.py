"""Methods to fill gaps: (gapped (n_frames, n_channels), NaN = missing, frame rate) -> no NaN.

Where a channel is never observed, the methods that look at one channel leave NaN: there is
nothing they could say.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline, PchipInterpolator

from solvers.arrays import Array

MIN_OBSERVED_FRAMES = 2


def linear(gapped: Array, frame_rate: float) -> Array:
    """Straight lines; the last observed value beyond the ends."""
    frames = np.arange(len(gapped))
    return _each(gapped, lambda observed, values: np.interp(frames, observed, values))


def pchip(gapped: Array, frame_rate: float) -> Array:
    """Monotone cubic pieces, as the MoCap Toolbox fills."""
    return _each(
        gapped, lambda observed, values: _inside(gapped, observed, values, PchipInterpolator)
    )


def cubic(gapped: Array, frame_rate: float) -> Array:
    """Cubic spline through all observed samples."""
    return _each(
        gapped, lambda observed, values: _inside(gapped, observed, values, CubicSpline)
    )


def soft_impute(gapped: Array, frame_rate: float, shrink: float) -> Array:
    """Low-rank completion of the matrix of frames by channels (Mazumder et al. 2010).

    `shrink` is the last threshold on singular values, as a fraction of the largest; as in the
    paper, it is reached from larger ones.
    """
    observed = np.isfinite(gapped)
    mean = np.nanmean(np.where(observed.any(axis=0), gapped, 0.0), axis=0)
    given = np.where(observed, gapped - mean, 0.0)
    filled = np.where(observed, given, linear(gapped, frame_rate) - mean)
    filled = np.nan_to_num(filled)
    for level in np.repeat(np.geomspace(0.5, shrink, 15), 5):
        # The right singular vectors from the small Gram matrix: takes are tall.
        squares, V = np.linalg.eigh(filled.T @ filled)
        singular = np.sqrt(np.maximum(squares, 1e-12))
        shrinkage = np.maximum(1.0 - level * singular[-1] / singular, 0.0)
        filled = np.where(observed, given, filled @ (V * shrinkage) @ V.T)
    return np.where(observed, gapped, filled + mean)


def conditional_pose(gapped: Array, frame_rate: float, training: Sequence[Array]) -> Array:
    """Expected values of the missing channels of each pose, given its observed ones.

    A Gaussian over poses, learned from the training clips; time plays no part.
    """
    frames = np.concatenate(training)
    mean, covariance = frames.mean(axis=0), np.cov(frames.T)
    covariance += 1e-2 * np.mean(np.diag(covariance)) * np.eye(len(mean))
    result = gapped.copy()
    patterns, which = np.unique(np.isfinite(gapped), axis=0, return_inverse=True)
    for number, observed in enumerate(patterns):
        if observed.all():
            continue
        rows = np.flatnonzero(which.ravel() == number)
        deviations = gapped[np.ix_(rows, observed)] - mean[observed]
        weights = np.linalg.solve(
            covariance[np.ix_(observed, observed)], covariance[np.ix_(observed, ~observed)]
        )
        result[np.ix_(rows, ~observed)] = mean[~observed] + deviations @ weights
    return result


def _each(gapped: Array, fill) -> Array:
    result = gapped.copy()
    for channel, values in enumerate(gapped.T):
        observed = np.flatnonzero(np.isfinite(values))
        if MIN_OBSERVED_FRAMES <= len(observed) < len(values):
            gaps = ~np.isfinite(values)
            result[gaps, channel] = fill(observed, values[observed])[gaps]
    return result


def _inside(gapped: Array, observed: NDArray[np.intp], values: Array, curve) -> Array:
    """Interpolate between the first and last observed frame; hold the values beyond."""
    frames = np.clip(np.arange(len(gapped)), observed[0], observed[-1])
    return np.asarray(curve(observed, values)(frames))
