"""Stack the estimate with smoothers, joint by joint, by their expected error.

The windows' prior is stationary: it smooths a take's fast moments like its still ones. A joint
is therefore the weighted mean of the estimate and of two smoothers.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...signals import shrink_noise
from ..posterior import Estimate, Smoothed

POOLED_JOINTS = 4.0
"""Weight, in joints, of the assumption that a smoother serves a joint as well as it serves the
others. Chosen by hand on the development takes of the first press: x0.25 costs 0.5 %."""
ADAPTATION_PENALTY = 1.2
"""Factor of the leverage of an estimate whose patterns have adapted to each sample, too.
Chosen by hand on the development takes of the first press: 1 costs 16 % on clean takes and
gains 1.5 % at 3 degrees of noise; 1.5 moves nothing."""
NOISE_QUANTILE = 0.2
"""Fraction of the third differences that is taken for noise alone: movement is in the others.
Chosen by hand on clean takes, where the median takes fast movement for noise."""
GAUSSIAN_QUANTILE = 0.2533
"""Standard deviations that this fraction of Gaussian numbers stays below. By definition."""
NOISE_EFFICIENCY = 0.3
"""Fraction: efficiency of that quantile, relative to a standard deviation. Chosen by hand:
x0.5 and x2 change the mean by less than 0.1 %."""
MIN_NOISE = 1e-3
"""Degrees or centimeters. Guards a division."""
RIDGE = 1e-9
"""Fraction of the trace. Guards equal candidates."""


def stack_estimates(
    noisy: Array,
    estimate: Estimate,
    smoothers: Sequence[Smoothed],
    is_good: NDArray[np.bool_],
    *,
    adapted: bool = False,
) -> tuple[Estimate, Array]:
    """Return the weighted mean of the estimate and the smoothers, and the weights.

    The weights of a joint are not negative, sum to 1 and minimize Stein's unbiased estimate of
    the squared error [1]_: the residual plus twice the noise times the leverage, the weight of
    each sample in its own estimate.

    Parameters
    ----------
    noisy : shape (n_frames, n_channels)
        Each joint has three channels.
    estimate : Estimate
    smoothers : sequence of Smoothed
        Of the same take.
    is_good : shape (n_frames, n_channels)
        Samples that are compared: observed ones that are no outliers. A joint without any keeps
        its estimate.
    adapted : bool
        Whether the patterns of the estimate come from the take alone.

    Returns
    -------
    Estimate
    weights : shape (n_joints, 1 + n_smoothers)
        Of the estimate, then of the smoothers.

    References
    ----------
    .. [1] Stein (1981). Estimation of the mean of a multivariate normal distribution. Annals of
       Statistics 9. doi:10.1214/aos/1176345632
    """
    candidates: list[Estimate | Smoothed] = [estimate, *smoothers]
    complete = np.where(is_good, noisy, estimate.values)
    residuals = np.stack([
        np.where(is_good, complete - each.values, 0.0) for each in candidates
    ])
    leverages = np.stack([
        _leverage(residual, each.leave_one_out_error)
        for residual, each in zip(residuals, candidates, strict=True)
    ])
    if adapted:
        leverages[0] = np.minimum(ADAPTATION_PENALTY * leverages[0], 1.0)
    variance = _noise(np.where(is_good, noisy, np.nan)) ** 2
    joints = (-1, 3)
    products = np.einsum("itc,jtc->cij", residuals, residuals)
    products = products.reshape(*joints, *products.shape[1:]).sum(axis=1)
    freedom = np.where(is_good, leverages, 0.0).sum(axis=1) * variance
    freedom = 2.0 * freedom.reshape(len(candidates), *joints).sum(axis=2).T
    scale = (variance * is_good.sum(axis=0)).reshape(joints).sum(axis=1)
    compared = scale > 0.0
    weights = np.zeros((len(products), len(candidates)))
    weights[:, 0] = 1.0
    if compared.any():
        products = products[compared] / scale[compared, None, None]
        freedom = freedom[compared] / scale[compared, None]
        products = products + POOLED_JOINTS * products.mean(axis=0)
        freedom = freedom + POOLED_JOINTS * freedom.mean(axis=0)
        weights[compared] = [
            _least_error_weights(*each) for each in zip(products, freedom, strict=True)
        ]
    return _blend(estimate, smoothers, np.repeat(weights, 3, axis=0).T, is_good), weights


def _leverage(residual: Array, leave_one_out_error: Array) -> Array:
    """Return the weight of each sample in its own estimate, from both of its errors."""
    known = np.isfinite(leave_one_out_error) & (leave_one_out_error != 0.0)
    ratio = np.divide(residual, leave_one_out_error, out=np.zeros_like(residual), where=known)
    return np.asarray(np.clip(1.0 - ratio, 0.0, 1.0))


def _noise(samples: Array) -> Array:
    """Return the standard deviation of each channel's noise, from its stillest moments."""
    if len(samples) <= 3:
        return np.full(samples.shape[1], MIN_NOISE)
    differences = np.abs(np.diff(samples, 3, axis=0)) / np.sqrt(20.0)
    n_known = np.isfinite(differences).sum(axis=0)
    ordered = np.sort(differences, axis=0)  # NaN last
    rank = np.round(NOISE_QUANTILE * np.maximum(n_known - 1, 0)).astype(int)
    noise = ordered[rank, np.arange(samples.shape[1])] / GAUSSIAN_QUANTILE
    noise = np.maximum(np.nan_to_num(noise), MIN_NOISE)
    return shrink_noise(noise, n_known, NOISE_EFFICIENCY)


def _least_error_weights(products: Array, freedom: Array) -> Array:
    """Return the weights w, not negative and of sum 1, of the least w' products w + freedom w.

    The solution is that of the subset of candidates whose weights are positive.
    """
    n_candidates = len(products)
    ridge = RIDGE * (np.trace(products) + freedom.max() + MIN_NOISE)
    best, least = np.zeros(n_candidates), np.inf
    for size in range(1, n_candidates + 1):
        for subset in map(list, combinations(range(n_candidates), size)):
            block, linear = products[np.ix_(subset, subset)], freedom[subset]
            system = np.ones((size + 1, size + 1))
            system[:size, :size] = 2.0 * block + ridge * np.eye(size)
            system[size, size] = 0.0
            weights = np.linalg.solve(system, np.append(-linear, 1.0))[:size]
            error = weights @ block @ weights + linear @ weights
            if (weights >= 0.0).all() and error < least:
                best, least = np.zeros(n_candidates), error
                best[subset] = weights
    return best


def _blend(
    estimate: Estimate,
    smoothers: Sequence[Smoothed],
    weights: Array,
    is_good: NDArray[np.bool_],
) -> Estimate:
    """Return the weighted mean, with weights of shape (1 + n_smoothers, n_channels)."""
    own, others = weights[0], list(zip(weights[1:], smoothers, strict=True))
    variance = own * estimate.deviation**2 + sum(w * each.variance for w, each in others)
    return replace(
        estimate,
        values=own * estimate.values + sum(w * each.values for w, each in others),
        deviation=np.where(is_good, np.sqrt(variance), estimate.deviation),
        leave_one_out_error=own * estimate.leave_one_out_error
        + sum(w * each.leave_one_out_error for w, each in others),
    )
