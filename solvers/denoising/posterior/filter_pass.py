"""One pass of the filter over all windows, and what it tells of the take."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .filters import Filter
from .windows import Windows

Array = NDArray[np.float64]

BLOCK = 512
"""Windows worked on at a time: this bounds the memory, however long the take."""


@dataclass(eq=False)
class Sweep:
    """What one pass over all windows adds up."""

    total: Array
    """Tapered posterior means, shape (n_frames, n_channels)."""
    slow_moment: Array
    """Mean second moment of the slow waves, a square matrix."""
    fast_power: Array
    """Mean square of the measured fast waves, shape (length - n_slow, n_channels)."""


def swept(drawn: Array, filters: list[Filter], windows: Windows, with_moments: bool) -> Sweep:
    """Filter every window; sum windows and, where asked for, second moments."""
    n_channels = drawn.shape[1]
    size, n_slow = len(filters[0].gains.slow), len(filters[0].gains.slow) // n_channels
    sweep = Sweep(
        np.zeros_like(drawn), np.zeros((size, size)), np.zeros_like(filters[0].gains.fast)
    )
    for one in filters:
        scale = np.tile(one.gains.noise, n_slow)
        for first in range(0, len(one.pattern.starts), BLOCK):
            starts = one.pattern.starts[first : first + BLOCK]
            frames = windows.cut(drawn, starts)
            waves = windows.waves_of(frames)
            seen = windows.waves_of(one.pattern.observed(frames)) if one.gaps else waves
            slow = seen[:, :n_slow].reshape(-1, size) / scale
            slow = (
                one.gaps.mean(slow, one.pattern.places) if one.gaps else slow @ one.gains.slow
            )
            slow *= scale
            if with_moments:
                sweep.slow_moment += slow.T @ slow
                sweep.fast_power += (waves[:, n_slow:] ** 2).sum(axis=0)
            waves[:, :n_slow] = slow.reshape(-1, n_slow, n_channels)
            waves[:, n_slow:] *= one.gains.fast
            windows.add(sweep.total, windows.frames_of(waves), starts)
        if with_moments:
            one.add_covariance(sweep.slow_moment)
    n_windows = sum(len(one.pattern.starts) for one in filters)
    sweep.slow_moment /= n_windows
    sweep.fast_power /= n_windows
    return sweep
