"""Stack the estimate with a plain smoothing spline, joint by joint, by held-out prediction.

The windows' prior is stationary: of a kick or punch it makes outliers, and in clean takes it
smooths more than a spline. A joint therefore keeps only the outliers that pay, and its estimate
is weighted by how well it predicts each sample from all others.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import gammaln

from ...arrays import Array
from .estimate import Estimate
from .estimate_channels import OUTLIER_DENSITY
from .smoothing_spline import Smoothed, smooth_by_spline

DEGREES_OF_FREEDOM = 4.0
"""Number that shapes Student's t distribution of prediction errors, which are larger in fast
motion; a count. From Lange, Little, Taylor (1989), doi:10.1080/01621459.1989.10478852."""
N_SCALE_UPDATES = 20
"""Updates of the scale of that distribution (expectation maximization)."""
PRIOR_SAMPLES = 1000.0
"""The number of samples, one of them an outlier, in addition to the take's own. A clean
take has hardly any outliers. Chosen by hand; not swept."""
POOLED_JOINTS = 4.0
"""Weight, in joints, of the assumption that the spline serves a joint as well as it serves the
others. Chosen by hand on the development takes of the first press: x0.25 costs 0.9 % at 3
degrees of noise, x4 gains 0.4 %."""
OUTLIER_THRESHOLD = 0.5
"""Probability of being an inlier below which a sample is an outlier. By definition."""
MIN_VARIANCE = 1e-12
"""Square degrees or centimeters. Guards a division and the logarithm of zero."""


def stack_with_spline(
    noisy: Array, estimate: Estimate, *, keep_outliers: bool = False
) -> tuple[Estimate, int]:
    """Return the estimate, stacked with a spline, and the number of joints it serves better.

    A joint without outliers is the weighted mean of both that minimizes the leave-one-out error
    [1]_. A joint with outliers keeps them if they are more likely than a spline through all of
    its samples. Then it keeps its estimate, too; otherwise the spline replaces it.

    Parameters
    ----------
    noisy : shape (n_frames, n_channels)
        NaN where not observed; each joint has three channels.
    estimate : Estimate
        With leave-one-out errors; NaN in channels that were not estimated.
    keep_outliers : bool
        Keep all outliers, because examples of the movement found them in the other limbs.

    References
    ----------
    .. [1] Breiman (1996). Stacked regressions. Machine Learning 24. doi:10.1007/BF00117832
    """
    known = np.isfinite(noisy) & np.isfinite(estimate.leave_one_out_error)
    outliers = known & (estimate.inliers < OUTLIER_THRESHOLD)
    spline = smooth_by_spline(np.where(known, noisy, estimate.values))
    errors = [
        (estimate.leave_one_out_error[:, joint], spline.leave_one_out_error[:, joint])
        for joint in _joints(noisy)
    ]
    masks = [(known[:, joint], outliers[:, joint]) for joint in _joints(noisy)]
    log_rate = np.log((outliers.sum() + 1.0) / (known.sum() + PRIOR_SAMPLES))
    weights = _stacking_weights(errors, masks)
    for joint, ((own, plain), (is_known, is_outlier)) in enumerate(
        zip(errors, masks, strict=True)
    ):
        if is_outlier.any() and not keep_outliers:
            with_outliers = _log_likelihood(own[is_known & ~is_outlier])
            with_outliers += is_outlier.sum() * (log_rate + np.log(OUTLIER_DENSITY))
            weights[joint] = with_outliers > _log_likelihood(plain[is_known])
    is_spurious = outliers & (np.repeat(weights, 3) == 0.0)
    stacked = _blend(estimate, spline, np.repeat(weights, 3), known)
    stacked = replace(stacked, inliers=np.where(is_spurious, 1.0, stacked.inliers))
    return stacked, int(np.count_nonzero(weights < 0.5))


def _joints(noisy: Array) -> list[slice]:
    return [slice(first, first + 3) for first in range(0, noisy.shape[1], 3)]


def _stacking_weights(
    errors: Sequence[tuple[Array, Array]],
    masks: Sequence[tuple[NDArray[np.bool_], NDArray[np.bool_]]],
) -> Array:
    """Return the weight of the estimate in each joint; 1 where the spline cannot be compared.

    The squared error of w a + (1 - w) b is least at w = -b (a - b) / (a - b)^2, summed over the
    samples and, with a small weight, over the other joints.
    """
    sums = np.zeros((len(errors), 2))
    for joint, ((own, plain), (is_known, is_outlier)) in enumerate(
        zip(errors, masks, strict=True)
    ):
        if is_known.any() and not is_outlier.any():
            a, b = own[is_known], plain[is_known]
            scale = min(np.mean(a**2), np.mean(b**2)) + MIN_VARIANCE
            sums[joint] = -np.sum(b * (a - b)) / scale, np.sum((a - b) ** 2) / scale
    compared = sums[:, 1] > 0.0
    if compared.any():
        sums[compared] += POOLED_JOINTS * sums[compared].mean(axis=0)
    return np.where(
        compared, np.clip(sums[:, 0] / np.maximum(sums[:, 1], MIN_VARIANCE), 0.0, 1.0), 1.0
    )


def _log_likelihood(errors: Array) -> float:
    """Return the log-likelihood of errors under Student's t distribution of the best scale."""
    if not errors.size:
        return 0.0
    variance = np.mean(errors**2) + MIN_VARIANCE
    for _ in range(N_SCALE_UPDATES):
        weights = (DEGREES_OF_FREEDOM + 1.0) / (DEGREES_OF_FREEDOM + errors**2 / variance)
        variance = np.mean(weights * errors**2) + MIN_VARIANCE
    n = DEGREES_OF_FREEDOM
    constant = gammaln((n + 1.0) / 2.0) - gammaln(n / 2.0) - np.log(n * np.pi * variance) / 2.0
    tails = (n + 1.0) / 2.0 * np.log1p(errors**2 / (n * variance))
    return float((constant - tails).sum())


def _blend(
    estimate: Estimate, spline: Smoothed, weights: Array, known: NDArray[np.bool_]
) -> Estimate:
    """Return the weighted mean of the estimate and the spline, with its deviation."""
    residuals = np.where(known, spline.leave_one_out_error * (1.0 - spline.leverage), 0.0)
    freedom = np.maximum((known * (1.0 - spline.leverage)).sum(axis=0), 1.0)
    variance = spline.leverage * (residuals**2).sum(axis=0) / freedom
    mixed_variance = weights * estimate.deviation**2 + (1.0 - weights) * variance
    return replace(
        estimate,
        values=weights * estimate.values + (1.0 - weights) * spline.values,
        deviation=np.where(known, np.sqrt(mixed_variance), estimate.deviation),
        leave_one_out_error=weights * estimate.leave_one_out_error
        + (1.0 - weights) * spline.leave_one_out_error,
    )
