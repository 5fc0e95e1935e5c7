"""The noise of each channel of a take."""

import numpy as np

from ...arrays import Array
from ...signals import estimate_noise, shrink_noise

MAX_CONSTANT_RANGE = 1e-7
"""Degrees or centimeters over which a channel that stands still varies. Guards against rounding
errors."""


def estimate_channel_noise(samples: Array, minimum: float) -> Array:
    """Return the standard deviation of the noise of each channel, shape (n_channels,).

    Channels that stand still do not count for the others; they get the others' noise.

    Parameters
    ----------
    samples : shape (n_frames, n_channels)
        NaN where missing.
    minimum : float
        Smallest noise, degrees or centimeters.
    """
    known = np.isfinite(samples)
    highest = np.where(known, samples, -np.inf).max(axis=0)
    lowest = np.where(known, samples, np.inf).min(axis=0)
    n_samples = known.sum(axis=0) * (highest - lowest > MAX_CONSTANT_RANGE)
    noise = np.maximum(estimate_noise(samples), minimum)
    return np.maximum(shrink_noise(noise, n_samples), minimum)
