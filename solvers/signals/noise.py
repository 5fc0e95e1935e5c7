"""Estimate noise and reject outliers without a model of the motion."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from .linear_gaps import fill_gaps

MAD_TO_SIGMA = 1.4826
"""Ratio of the standard deviation of a Gaussian to its median absolute deviation. By
definition, 1 / 0.6745."""
# Third differences nearly cancel smooth motion; on white noise their variance is
# 1 + 9 + 9 + 1 times that of one sample.
DIFFERENCE_ORDER = 3
DIFFERENCE_GAIN = np.sqrt(20.0)
"""Ratio of the standard deviation of third differences of white noise to its own, by
definition."""
DIFFERENCE_EFFICIENCY = 0.21
"""Statistical efficiency of the median absolute third difference, relative to the sample
standard deviation. By definition: that of white noise, measured on 60 to 1000 frames."""
OUTLIER_SIGMAS = 3.5
"""Robust standard deviations of a moving window beyond which a sample is an outlier. Iglewicz
and Hoaglin (1993), How to Detect and Handle Outliers: modified z-scores above 3.5."""
SHRINKAGE_LIMIT_SIGMAS = 3.0
"""Sampling error beyond which a channel keeps its own estimate (three-sigma rule). Half and
twice are no better (`make sensitivity`)."""


def estimate_noise(values: Array) -> Array:
    """Return the standard deviation of the jitter of each channel, shape (n_channels,).

    The median absolute third difference, scaled: spikes and smooth motion contribute little.

    Parameters
    ----------
    values : shape (n_frames, n_channels)
        NaN where missing. Channels with too few consecutive frames give 0.
    """
    if len(values) <= DIFFERENCE_ORDER:
        return np.zeros(values.shape[1])
    differences = np.abs(np.diff(values, DIFFERENCE_ORDER, axis=0))
    return np.asarray(MAD_TO_SIGMA * _nan_median(differences) / DIFFERENCE_GAIN)


def shrink_noise(noise: Array, n_samples: NDArray[Any], efficiency: float = 1.0) -> Array:
    """Shrink the noise estimates of all channels toward their median (empirical Bayes).

    The logarithm of a standard deviation from n samples has sampling variance 1 / (2 n). Spread
    beyond that is true variation between channels, estimated robustly. A channel farther away
    than sampling explains, such as the root's position among rotations, keeps its own estimate.

    Parameters
    ----------
    noise : shape (n_channels,)
        Estimated standard deviations, positive.
    n_samples : shape (n_channels,)
        Number of samples behind each estimate; a channel with 0 gets the median of the others.
    efficiency : float
        Statistical efficiency of the estimate, relative to the sample standard deviation.
    """
    estimated = n_samples > 0
    if not estimated.any():
        return noise
    logs = np.log(noise)
    center = np.median(logs[estimated])
    sampling = 0.5 / np.maximum(efficiency * n_samples, 1.0)
    spread = (MAD_TO_SIGMA * np.median(np.abs(logs[estimated] - center))) ** 2
    excess = max(float(spread - np.median(sampling[estimated])), 0.0)
    excess = excess + np.maximum(
        (logs - center) ** 2 - SHRINKAGE_LIMIT_SIGMAS**2 * sampling, 0.0
    )
    weight = np.where(estimated, excess / (excess + sampling), 0.0)
    return np.asarray(np.exp(center + weight * (logs - center)))


def remove_outliers(values: Array, half_width: int) -> Array:
    """Return the channels with outliers replaced by NaN (Hampel filter).

    Parameters
    ----------
    values : shape (n_frames, n_channels)
        NaN where missing.
    half_width : int, frames to either side
    """
    from scipy.ndimage import median_filter  # slow to import: only when needed

    filled = fill_channel_gaps(values)
    size = (2 * half_width + 1, 1)
    center = median_filter(filled, size, mode="nearest")
    deviation = np.abs(filled - center)
    spread = MAD_TO_SIGMA * median_filter(deviation, size, mode="nearest")
    floor = 1e-9 + np.median(spread, axis=0)
    return np.where(deviation > OUTLIER_SIGMAS * np.maximum(spread, floor), np.nan, values)


def fill_channel_gaps(values: Array) -> Array:
    """Return channels, shape (n_frames, n_channels), with NaN linearly interpolated.

    The first and the last valid value are held at the ends; channels without one become 0.
    """
    filled = fill_gaps(values[..., np.newaxis])[..., 0]
    filled[np.isnan(filled)] = 0.0
    return filled


def _nan_median(values: Array) -> Array:
    """Return the median over the first axis without NaN; 0 where all are NaN."""
    valid = np.isfinite(values)
    safe = np.where(valid, values, np.inf)
    ordered = np.sort(safe, axis=0)
    count = valid.sum(axis=0)
    low = np.take_along_axis(ordered, np.maximum((count - 1) // 2, 0)[None], axis=0)[0]
    high = np.take_along_axis(ordered, np.minimum(count // 2, len(values) - 1)[None], axis=0)[0]
    with np.errstate(invalid="ignore"):
        return np.asarray(np.where(count > 0, (low + high) / 2, 0.0))
