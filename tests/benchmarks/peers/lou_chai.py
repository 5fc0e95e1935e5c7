"""[LC10] written a second time, on the benchmark's own channels.

A check that the method "published" of `denoise` is not hobbled by how we encode motion. The
channels are centered, which the paper does not do: kinder to it.
"""

from collections.abc import Sequence

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from solvers.arrays import Array

WINDOW, ENERGY, SCALE, WEIGHT, ITERATIONS, REWEIGHTINGS = 20, 0.99, 3.0, 0.1, 20, 3


def learn_patterns(training: Sequence[Array]) -> tuple[Array, Array]:
    """Return the mean and the filter bases E, shape (window * channels, K); eq. 2.1-2.7."""
    mean = np.concatenate(training).mean(axis=0)
    windows = [_windows(clip - mean) for clip in training if len(clip) >= WINDOW]
    size = windows[0].shape[1]
    covariance = sum((each.T @ each for each in windows), np.zeros((size, size)))
    values, vectors = np.linalg.eigh(covariance)
    energy = np.cumsum(values[::-1]) / values.sum()
    return mean, vectors[:, ::-1][:, : int(np.argmax(energy >= ENERGY)) + 1]


def filter_by_patterns(noisy: Array, mean: Array, E: Array) -> Array:
    """Alternate between the weights of all windows and the motion; eq. 2.11-2.15.

    A take that is shorter than the window comes back as it is.
    """
    if len(noisy) < WINDOW:
        return noisy.copy()
    y = noisy - mean
    z = y.copy()
    n_frames, n_channels = y.shape
    times = np.convolve(np.ones(n_frames - WINDOW + 1), np.ones(WINDOW))[:, None]
    for _ in range(ITERATIONS):
        patterns = (_windows(z) @ E @ E.T).reshape(-1, WINDOW, n_channels)
        total = np.zeros_like(z)
        for offset in range(WINDOW):
            total[offset : offset + len(patterns)] += patterns[:, offset]
        for _ in range(REWEIGHTINGS):
            w = np.exp(-(((z - y) / SCALE) ** 2))
            z = (WEIGHT * total + w * y) / (WEIGHT * times + w)
    return np.asarray(z + mean)


def _windows(values: Array) -> Array:
    windows = sliding_window_view(values, WINDOW, axis=0).transpose(0, 2, 1)
    return windows.reshape(len(windows), -1)
