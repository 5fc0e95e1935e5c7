"""The filter of Lou and Chai (2010) as printed, to compare with."""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from .denoise_estimate import Estimate
from .noise import interpolated
from .prior import WindowPrior

Array = NDArray[np.float64]

ENERGY = 0.99
WELSCH = 3.0
"""p of the Welsch estimator, degrees."""
PATTERN_WEIGHT = 0.1
"""lambda of eq. 2.10."""
N_REWEIGHTS = 3
MAX_ITERATIONS = 20
SETTLED = 1e-3
"""Relative change of the cost below which the alternation ends."""


def filter_as_published(noisy: Array, prior: WindowPrior) -> Estimate:
    """Minimise eq. 2.16 of [1]_ by alternating between pattern weights and motion.

    Eq. 2.15 drops the factor 1/2 of the Welsch function (eq. 2.9); it is kept here, so that
    each step lowers the cost that is printed. Channels are centred.

    Parameters
    ----------
    noisy : shape (n_frames, n_channels)
        NaN where not observed: the weights alpha of eq. 2.16 are 0 there.
    prior : WindowPrior
        Its covariance gives the patterns that hold 99 % of the energy.

    References
    ----------
    .. [1] Lou (2012). Acquiring 3D full-body motion from noisy and ambiguous input. PhD
       dissertation, Texas A&M, section 2.2.
    """
    patterns = strongest_patterns(prior, min(prior.window, len(noisy)))
    known = np.isfinite(noisy)
    observed = np.where(known, noisy - prior.mean, 0.0)
    motion = interpolated(noisy) - prior.mean
    weight, cost, converged, iteration = known.astype(float), np.inf, False, 0
    while iteration < MAX_ITERATIONS and not converged:
        iteration += 1
        fitted, count = fit_windows(motion, patterns)  # eq. 2.13
        pull = 2.0 * PATTERN_WEIGHT * count[:, None]
        for _ in range(N_REWEIGHTS):  # eq. 2.15
            weight = known * np.exp(-(((motion - observed) / WELSCH) ** 2))
            motion = (weight * observed + pull * fitted) / (weight + pull)
        before, cost = cost, published_cost(motion, observed, known, patterns)
        converged = before - cost < SETTLED * cost
    deviation = np.full(noisy.shape, WELSCH)
    return Estimate(motion + prior.mean, weight, deviation, iteration, converged)


def strongest_patterns(prior: WindowPrior, window: int) -> Array:
    """Return the eigenvectors that hold 99 % of the energy, shape (K, window, n_channels)."""
    n_channels = len(prior.mean)
    size = window * n_channels
    values, vectors = np.linalg.eigh(prior.covariance[:size, :size])
    values = np.maximum(values[::-1], 0.0)
    n_kept = int(np.searchsorted(np.cumsum(values), ENERGY * values.sum())) + 1
    return np.asarray(vectors[:, ::-1][:, :n_kept].T.reshape(n_kept, window, n_channels))


def fit_windows(motion: Array, patterns: Array) -> tuple[Array, Array]:
    """Project every window on the patterns; return the mean of all, and their number."""
    n_bases, window, _ = patterns.shape
    flat = patterns.reshape(n_bases, -1)
    windows = sliding_window_view(motion, window, axis=0).transpose(0, 2, 1)
    fitted = (windows.reshape(len(windows), -1) @ flat.T @ flat).reshape(windows.shape)
    total, count = np.zeros_like(motion), np.zeros(len(motion))
    for place in range(window):
        total[place : place + len(fitted)] += fitted[:, place]
        count[place : place + len(fitted)] += 1.0
    return total / count[:, None], count


def published_cost(motion: Array, observed: Array, known: Array, patterns: Array) -> float:
    """Return eq. 2.16 with the best pattern weights; both motions are centred."""
    n_bases, window, _ = patterns.shape
    windows = sliding_window_view(motion, window, axis=0).transpose(0, 2, 1)
    flat = windows.reshape(len(windows), -1)
    inside = flat @ patterns.reshape(n_bases, -1).T
    outside = (flat**2).sum() - (inside**2).sum()
    robust = WELSCH**2 / 2 * (1 - np.exp(-(((motion - observed) / WELSCH) ** 2)))
    return float((known * robust).sum() + PATTERN_WEIGHT * outside)
