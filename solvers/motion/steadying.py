"""Values over time made steady, with or without a look at what comes."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d
from scipy.signal import lfilter

Array = NDArray[np.float64]

REACH = 4.0
"""Widths of the Gaussian after which nothing counts."""


def steadied(values: Array, frames: float, *, ahead: bool = True) -> Array:
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
    if frames <= 0.0:
        return np.array(values, dtype=np.float64)
    if ahead:
        return np.asarray(gaussian_filter1d(values, frames, axis=0, mode="nearest"))
    reach = round(REACH * frames)
    weights = np.exp(-0.5 * (np.arange(reach + 1) / frames) ** 2)
    start = np.repeat(values[:1], reach, axis=0)
    filtered = lfilter(weights / weights.sum(), [1.0], np.concatenate([start, values]), axis=0)
    return np.asarray(filtered[reach:])
