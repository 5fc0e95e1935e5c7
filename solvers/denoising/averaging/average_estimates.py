"""Average the estimate with smoothers, joint by joint, by their expected error (stacking).

The windows' prior is stationary: it smooths fast and still intervals of a take equally. A joint
is therefore the weighted mean of the estimate and of two smoothers.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ..channels import Estimate, Smoothed
from .leverage import leverage
from .remaining_noise import MIN_NOISE

POOLED_JOINTS = 4.0
"""Weight, in joints, of the assumption that a smoother serves a joint as well as it serves the
others. Sweep on the development takes of the first press: x0.25 costs 0.5 %, 0 costs 6.7 %."""
RIDGE = 1e-9
"""Fraction of the trace. Guards equal candidates."""


def average_estimates(
    noisy: Array,
    estimate: Estimate,
    smoothers: Sequence[Smoothed],
    is_good: NDArray[np.bool_],
    noise: Array,
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
    noise : shape (n_channels,)
        Standard deviation.

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
        leverage(residual, each.leave_one_out_error)
        for residual, each in zip(residuals, candidates, strict=True)
    ])
    variance = np.square(noise)
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
        weights[compared] = _least_error_weights(products, freedom)
    return blend(estimate, smoothers, weights, is_good), weights


def _least_error_weights(products: Array, freedom: Array) -> Array:
    """Return the weights w, not negative and of sum 1, of the least w' products w + freedom w.

    The solution is that of the subset of candidates whose weights are positive.

    Parameters
    ----------
    products : shape (n_joints, n_candidates, n_candidates)
    freedom : shape (n_joints, n_candidates)
    """
    n_joints, n_candidates = freedom.shape
    ridge = np.trace(products, axis1=1, axis2=2) + freedom.max(axis=1) + MIN_NOISE
    best, least = np.zeros_like(freedom), np.full(n_joints, np.inf)
    for size in range(1, n_candidates + 1):
        for subset in map(list, combinations(range(n_candidates), size)):
            block, linear = products[:, subset][:, :, subset], freedom[:, subset]
            system = np.ones((n_joints, size + 1, size + 1))
            system[:, :size, :size] = 2.0 * block + RIDGE * ridge[:, None, None] * np.eye(size)
            system[:, size, size] = 0.0
            right = np.append(-linear, np.ones((n_joints, 1)), axis=1)[..., None]
            weights = np.linalg.solve(system, right)[:, :size, 0]
            error = np.einsum("ji,jik,jk->j", weights, block, weights)
            error += (linear * weights).sum(axis=1)
            better = (weights >= 0.0).all(axis=1) & (error < least)
            least = np.where(better, error, least)
            best[better] = 0.0
            best[np.ix_(better, subset)] = weights[better]
    return best


def blend(
    estimate: Estimate,
    smoothers: Sequence[Smoothed],
    weights: Array,
    is_good: NDArray[np.bool_],
) -> Estimate:
    """Return the weighted mean, with weights of shape (n_joints, 1 + n_smoothers)."""
    of_channels = np.repeat(weights, 3, axis=0).T
    own, others = of_channels[0], list(zip(of_channels[1:], smoothers, strict=True))
    variance = own * estimate.deviation**2 + sum(w * each.variance for w, each in others)
    return replace(
        estimate,
        values=own * estimate.values + sum(w * each.values for w, each in others),
        deviation=np.where(is_good, np.sqrt(variance), estimate.deviation),
        leave_one_out_error=own * estimate.leave_one_out_error
        + sum(w * each.leave_one_out_error for w, each in others),
    )
