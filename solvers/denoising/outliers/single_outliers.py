"""The outlier model of single samples: noise around the prediction, or a uniform error."""

import numpy as np

from ...arrays import Array

OUTLIER_DENSITY = 1.0 / 120.0
"""Density of an outlier's error, per degree or centimeter: uniform within +-60. Chosen by hand;
`make sensitivity` varies it."""
INLIER_STD_FLOOR = 0.5
"""Degrees or centimeters: standard deviation of an inlier, in addition to noise and prediction.
Chosen by hand; `make sensitivity` varies it."""
MIN_OUTLIER_RATE = 1e-4
"""Fraction of outliers before the first estimate, and the smallest one. It guards a division:
up to 0.3 at the start, errors differ by less than 0.5 %."""


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
