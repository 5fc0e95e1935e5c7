"""Values over time made steady, with or without a look at what comes."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import convolve1d, gaussian_filter1d

Array = NDArray[np.float64]

TRUNCATION_SIGMAS = 4.0
"""Widths of the Gaussian after which nothing counts."""


def smooth_gaussian(values: Array, frames: float, *, ahead: bool = True) -> Array:
    """Return the Gaussian mean of the frames around each, or of those up to it.

    Parameters
    ----------
    values : shape (n_frames, ...)
        Without gaps.
    frames : float
        Standard deviation of the Gaussian; 0 changes nothing.
    ahead : bool
        Whether frames count that come later. Without them the later half of the Gaussian is
        left out, and what is returned lags behind by 0.8 `frames`.
    """
    values = np.array(values, dtype=np.float64)
    if frames <= 0.0:
        return values
    if ahead:
        return np.asarray(gaussian_filter1d(values, frames, axis=0, mode="nearest"))
    reach = round(TRUNCATION_SIGMAS * frames)
    weights = np.exp(-0.5 * (np.arange(reach + 1) / frames) ** 2)
    before = {"mode": "nearest", "origin": -((reach + 1) // 2)}
    return np.asarray(convolve1d(values, weights / weights.sum(), axis=0, **before))
