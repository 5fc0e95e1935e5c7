"""The outlier model of single samples: noise around the prediction, or a uniform error."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...signals import MAD_TO_SIGMA

OUTLIER_DENSITY = 1.0 / 120.0
"""Density of an outlier's error, per degree or centimeter: uniform within +-60. Chosen by hand;
`make sensitivity` varies it."""
LOG_OUTLIER_DENSITY = float(np.log(OUTLIER_DENSITY))
"""Its natural logarithm. By definition."""
INLIER_STD_FLOOR = 0.5
"""Degrees or centimeters: standard deviation of an inlier, in addition to noise and prediction.
Chosen by hand; `make sensitivity` varies it."""
MIN_OUTLIER_RATE = 1e-4
"""Fraction of outliers before the first estimate, and the smallest one. It guards a division:
up to 0.3 at the start, errors differ by less than 0.5 %."""
MAX_FIT_ITERATIONS = 20
"""Iterations of the fit of noise and rate. It bounds the run time: x0.5 costs 3 % where a walk
has 40 % of outliers."""
MAX_SETTLED_FIT_CHANGE = 0.02
"""Relative change of the squared noise below which the fit has converged. It bounds the run
time."""


def compute_inlier_probability(error: Array, variance: Array, rate: float) -> Array:
    """Return the probability that each sample is no outlier.

    Parameters
    ----------
    error : shape (n_frames, n_channels)
        Distance from the prediction by all other samples, degrees or centimeters.
    variance : same shape
        Of the noise and of the prediction.
    rate : float
        Fraction of outliers.
    """
    variance = variance + INLIER_STD_FLOOR**2
    inlier_density = (1.0 - rate) * np.exp(-0.5 * error**2 / variance)
    inlier_density /= np.sqrt(2 * np.pi * variance)
    return np.asarray(inlier_density / (inlier_density + rate * OUTLIER_DENSITY))


def fit_inlier_probability(
    error: Array, variance: Array, is_valid: NDArray[np.bool_], rate: float
) -> Array:
    """Return the probability that each sample is no outlier, whatever the noise is.

    Noise and rate are those that explain the errors best (expectation maximization). The fit
    starts at the median error, so that a given noise that is far too large does not hide the
    outliers.

    Parameters
    ----------
    error : shape (n_frames, n_channels)
        Distance from the prediction by all other samples, degrees or centimeters.
    variance : same shape
        Of the prediction, without the noise.
    is_valid : same shape
        Samples that were observed and may be right; the others have the probability zero.
    rate : float
        First fraction of outliers.
    """
    magnitude = np.where(is_valid, np.abs(error), np.nan)
    magnitude[:, ~is_valid.any(axis=0)] = 0.0
    noise_variance = (MAD_TO_SIGMA * np.nanmedian(magnitude, axis=0)) ** 2
    probability = is_valid.astype(float)
    for _ in range(MAX_FIT_ITERATIONS):
        total_variance = noise_variance + variance + INLIER_STD_FLOOR**2
        probability = is_valid * compute_inlier_probability(
            error, noise_variance + variance, rate
        )
        gain = noise_variance / total_variance
        square = (gain * error) ** 2 + noise_variance * (1.0 - gain)
        total = np.maximum(probability.sum(axis=0), MIN_OUTLIER_RATE)
        before, noise_variance = noise_variance, (probability * square).sum(axis=0) / total
        rate = outlier_rate(probability, is_valid)
        if (np.abs(noise_variance - before) <= MAX_SETTLED_FIT_CHANGE * before).all():
            break
    return probability


def outlier_rate(inlier_probability: Array, is_valid: NDArray[np.bool_]) -> float:
    """Return the fraction of outliers among the valid samples, above 0 and below 1.

    Both arrays have one shape, such as (n_frames, n_channels).
    """
    n_valid = int(np.count_nonzero(is_valid))
    fraction = (n_valid - float(inlier_probability[is_valid].sum())) / max(n_valid, 1)
    return float(np.clip(fraction, MIN_OUTLIER_RATE, 1.0 - MIN_OUTLIER_RATE))
