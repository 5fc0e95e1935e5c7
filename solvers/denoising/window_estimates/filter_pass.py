"""Apply the filters to all windows once, and collect statistics of the take."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ..window_priors import Windows
from .filters import Filter, sum_covariances

MAX_BLOCK_WINDOWS = 512
"""Windows processed at a time: this bounds the memory, however long the take."""


@dataclass(eq=False)
class FilterPass:
    """Sums of one pass over all windows."""

    total: Array
    """Tapered posterior means, shape (n_frames, n_channels)."""
    slow_moment: Array
    """Mean second moment of the slow coefficients, a square matrix."""
    fast_power: Array
    """Mean square of the measured fast coefficients, shape (length - n_slow, n_channels)."""


def filter_windows(
    blended: Array, filters: list[Filter], windows: Windows, with_moments: bool
) -> FilterPass:
    """Filter every window of samples, (n_frames, n_channels); sum windows and, if requested,
    second moments."""
    n_channels = blended.shape[1]
    size, n_slow = len(filters[0].gains.slow), len(filters[0].gains.slow) // n_channels
    result = FilterPass(
        np.zeros_like(blended), np.zeros((size, size)), np.zeros_like(filters[0].gains.fast)
    )
    for window_filter in filters:
        scale = np.tile(window_filter.gains.noise, n_slow)
        for first in range(0, len(window_filter.pattern.starts), MAX_BLOCK_WINDOWS):
            starts = window_filter.pattern.starts[first : first + MAX_BLOCK_WINDOWS]
            frames = windows.extract(blended, starts)
            coefficients = windows.coefficients_from_frames(frames)
            observed = (
                windows.coefficients_from_frames(window_filter.pattern.mask_frames(frames))
                if window_filter.gaps
                else coefficients
            )
            slow = (observed[:, :n_slow] / window_filter.gains.noise).reshape(-1, size)
            slow = (
                window_filter.gaps.posterior_mean(slow, window_filter.pattern.indices)
                if window_filter.gaps
                else window_filter.gains.posterior_mean(slow)
            )
            slow *= scale
            if with_moments:
                result.slow_moment += slow.T @ slow
                result.fast_power += (coefficients[:, n_slow:] ** 2).sum(axis=0)
            coefficients[:, :n_slow] = slow.reshape(-1, n_slow, n_channels)
            coefficients[:, n_slow:] *= window_filter.gains.fast
            windows.add(result.total, windows.frames_from_coefficients(coefficients), starts)
    if with_moments:
        result.slow_moment += sum_covariances(filters)
    n_windows = sum(len(window_filter.pattern.starts) for window_filter in filters)
    result.slow_moment /= n_windows
    result.fast_power /= n_windows
    return result
