"""Smooth values over time with a Gaussian filter, zero-phase or causal."""

from collections import deque

import numpy as np

from ..arrays import Array

TRUNCATION_SIGMAS = 4.0
"""Standard deviations at which a Gaussian is truncated, by definition as in
`scipy.ndimage.gaussian_filter1d`. With one, the causal one would lag by half as much as it
says."""


def smooth_gaussian(values: Array, frames: float, *, causal: bool = False) -> Array:
    """Return the Gaussian-weighted mean of the frames around each frame, or of those up to it.

    Parameters
    ----------
    values : shape (n_frames, ...)
        Without gaps.
    frames : float
        Standard deviation of the Gaussian; 0 changes nothing.
    causal : bool
        False: a zero-phase filter, which uses later frames too. True: a causal filter, the
        earlier half of the Gaussian; its result lags by 0.8 `frames`.
    """
    from scipy.ndimage import convolve1d, gaussian_filter1d  # slow to import: only when needed

    values = np.array(values, dtype=np.float64)
    if frames <= 0.0:
        return values
    if not causal:
        return np.asarray(gaussian_filter1d(values, frames, axis=0, mode="nearest"))
    width = round(TRUNCATION_SIGMAS * frames)
    weights = np.exp(-0.5 * (np.arange(width + 1) / frames) ** 2)
    options = {"mode": "nearest", "origin": -((width + 1) // 2)}
    return np.asarray(convolve1d(values, weights / weights.sum(), axis=0, **options))


class CausalSmoother:
    """`smooth_gaussian` without later frames, one frame after another.

    Parameters
    ----------
    frames : float
        Standard deviation of the Gaussian.
    """

    def __init__(self, frames: float) -> None:
        self._frames = frames
        self._past: deque[Array] = deque(maxlen=round(TRUNCATION_SIGMAS * frames) + 1)

    def update(self, values: Array) -> Array:
        """Return the mean of these values and those before, same shape; NaN stays NaN."""
        self._past.append(values)
        return np.asarray(smooth_gaussian(np.stack(self._past), self._frames, causal=True)[-1])


def smooth_to_the_ends(values: Array, frames: float) -> Array:
    """Return the zero-phase Gaussian-weighted mean of a path that goes on beyond its ends.

    The path is extended by point reflection. So a walk keeps its speed at both ends of a clip.

    Parameters
    ----------
    values : shape (n_frames, ...)
        Without gaps.
    frames : float
        Standard deviation of the Gaussian; 0 changes nothing.
    """
    width = min(int(TRUNCATION_SIGMAS * frames) + 1, len(values) - 1)
    padding = [(width, width), *[(0, 0)] * (values.ndim - 1)]
    padded = np.pad(values, padding, mode="reflect", reflect_type="odd")
    return smooth_gaussian(padded, frames)[width : width + len(values)]
