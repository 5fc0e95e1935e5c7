"""What can be said of the noise before any model of the motion is known."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

Array = NDArray[np.float64]

MAD_TO_SIGMA = 1.4826
"""Standard deviation of a Gaussian over its median absolute deviation."""
# Third differences pass smooth motion down to almost nothing; on white noise they have the
# variance 1 + 9 + 9 + 1 times that of one sample.
DIFFERENCE_ORDER = 3
DIFFERENCE_GAIN = np.sqrt(20.0)
SHRINKAGE_LIMIT_SIGMAS = 3.0
"""Standard deviations by which chance alone hardly ever moves an estimate."""


def estimate_noise(values: Array) -> Array:
    """Return the standard deviation of the fast jitter of each channel, shape (n_channels,).

    The robust spread of third differences: spikes and smooth motion count for little.

    Parameters
    ----------
    values : shape (n_frames, n_channels)
        NaN where not observed. Channels with too few neighbouring frames give 0.
    """
    if len(values) <= DIFFERENCE_ORDER:
        return np.zeros(values.shape[1])
    differences = np.abs(np.diff(values, DIFFERENCE_ORDER, axis=0))
    return np.asarray(MAD_TO_SIGMA * _nan_median(differences) / DIFFERENCE_GAIN)


def shrink_noise(noise: Array, n_samples: NDArray[Any], efficiency: float = 1.0) -> Array:
    """Draw the noise of all channels together, as far as their spread is mere chance.

    The logarithm of a standard deviation from n samples is uncertain by 1 / (2 n); what spread
    there is beyond that is real (empirical Bayes, robustly). A channel that is farther off
    than chance explains, as a root's place may be among rotations, keeps what is its own.

    Parameters
    ----------
    noise : shape (n_channels,)
        Estimated standard deviations, positive.
    n_samples : shape (n_channels,)
        That each was estimated from; where 0, the others tell all.
    efficiency : float
        Of the estimate, relative to that of the standard deviation of a Gaussian.
    """
    seen = n_samples > 0
    if not seen.any():
        return noise
    logs = np.log(noise)
    middle = np.median(logs[seen])
    chance = 0.5 / np.maximum(efficiency * n_samples, 1.0)
    spread = (MAD_TO_SIGMA * np.median(np.abs(logs[seen] - middle))) ** 2
    real = max(float(spread - np.median(chance[seen])), 0.0)
    real = real + np.maximum((logs - middle) ** 2 - SHRINKAGE_LIMIT_SIGMAS**2 * chance, 0.0)
    trust = np.where(seen, real / (real + chance), 0.0)
    return np.asarray(np.exp(middle + trust * (logs - middle)))


def remove_outliers(values: Array, half_width: int, tolerance: float) -> Array:
    """Return the channels with every sample that stands out from its neighbours made NaN.

    Parameters
    ----------
    values : shape (n_frames, n_channels)
        NaN where not observed.
    half_width : int, frames to either side
    tolerance : float
        In robust standard deviations of the neighbourhood.
    """
    filled = fill_channel_gaps(values)
    size = (2 * half_width + 1, 1)
    middle = median_filter(filled, size, mode="nearest")
    departure = np.abs(filled - middle)
    spread = MAD_TO_SIGMA * median_filter(departure, size, mode="nearest")
    floor = 1e-9 + np.median(spread, axis=0)
    return np.where(departure > tolerance * np.maximum(spread, floor), np.nan, values)


def fill_channel_gaps(values: Array) -> Array:
    """Return the channels with NaN replaced on straight lines between what is observed.

    Before the first and after the last observation its value is held; channels that are never
    observed become 0.
    """
    result = values.copy()
    frames = np.arange(len(values))
    for channel in np.flatnonzero(np.isnan(values).any(axis=0)):
        known = np.isfinite(values[:, channel])
        if known.any():
            line = np.interp(frames, frames[known], values[known, channel])
            result[:, channel] = line
        else:
            result[:, channel] = 0.0
    return result


def _nan_median(values: Array) -> Array:
    """Median over the first axis without NaN; 0 where all are NaN."""
    known = np.isfinite(values)
    safe = np.where(known, values, np.inf)
    ordered = np.sort(safe, axis=0)
    count = known.sum(axis=0)
    low = np.take_along_axis(ordered, np.maximum((count - 1) // 2, 0)[None], axis=0)[0]
    high = np.take_along_axis(ordered, np.minimum(count // 2, len(values) - 1)[None], axis=0)[0]
    with np.errstate(invalid="ignore"):
        return np.asarray(np.where(count > 0, (low + high) / 2, 0.0))
