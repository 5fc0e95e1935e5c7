"""Smooth every channel by itself: a cubic smoothing spline with cross-validated smoothness."""

from functools import lru_cache

import numpy as np
import scipy

from ...arrays import Array
from ..channels import Smoothed
from ..motion_model import MAX_LEVERAGE

MAX_BLOCK_FRAMES = 512
"""Frames smoothed at a time; longer takes are blended from overlapping blocks. It bounds the
run time, which rises with its cube."""
SMOOTHNESS = np.geomspace(1e-4, 1e6, 61)
"""Candidate weights of the roughness, relative to the squared error, per frame to the fourth
power. It bounds the search: from no smoothing to a straight line."""


def smooth_by_spline(samples: Array) -> Smoothed:
    """Fit a smoothing spline to each channel.

    It minimizes the squared error plus the weighted squared second differences; generalized
    cross-validation chooses the weight [1]_.

    Parameters
    ----------
    samples : shape (n_frames, n_channels), without NaN

    References
    ----------
    .. [1] Craven, Wahba (1978). Smoothing noisy data with spline functions. Numerische
       Mathematik 31. doi:10.1007/BF01404567
    """
    n_frames = len(samples)
    length = min(n_frames, MAX_BLOCK_FRAMES)
    if length < 4:
        return Smoothed(samples, *(np.zeros_like(samples) for _ in range(2)))
    last = n_frames - length
    starts = np.unique(np.append(np.arange(0, last, length // 2), last))
    taper = np.minimum(np.arange(1, length + 1), np.arange(length, 0, -1))[:, None]
    sums, weight = [np.zeros_like(samples) for _ in Smoothed._fields], np.zeros((n_frames, 1))
    for start in starts:
        block = slice(start, start + length)
        for total, part in zip(sums, _smooth_block(samples[block]), strict=True):
            total[block] += taper * part
        weight[block] += taper
    return Smoothed(*(total / weight for total in sums))


def _smooth_block(samples: Array) -> Smoothed:
    basis, roughness = _demmler_reinsch_basis(len(samples))
    coefficients = basis.T @ samples
    remainders = 1.0 - 1.0 / (1.0 + SMOOTHNESS[:, None] * roughness)
    scores = remainders**2 @ coefficients**2 / remainders.sum(axis=1, keepdims=True) ** 2
    gains = 1.0 - remainders[scores.argmin(axis=0)].T
    values = basis @ (gains * coefficients)
    leverage = np.minimum(basis**2 @ gains, MAX_LEVERAGE)
    residuals = samples - values
    freedom = np.maximum((1.0 - leverage).sum(axis=0), 1.0)
    variance = leverage * (residuals**2).sum(axis=0) / freedom
    return Smoothed(values, residuals / (1.0 - leverage), variance)


@lru_cache(maxsize=4)
def _demmler_reinsch_basis(length: int) -> tuple[Array, Array]:
    """Return the basis in which the spline is diagonal, and the roughness of its columns."""
    second_differences = np.diff(np.eye(length), 2, axis=0)
    roughness, basis = scipy.linalg.eigh(second_differences.T @ second_differences)
    roughness[:2] = 0.0  # straight lines
    return basis, np.maximum(roughness, 0.0)
