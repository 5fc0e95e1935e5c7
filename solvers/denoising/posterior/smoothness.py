"""How fast the channels of a take move, told by the take itself."""

import numpy as np
from numpy.typing import NDArray
from scipy.fft import idct

from .windows import Windows

Array = NDArray[np.float64]

LENGTHS = (0.08, 0.16, 0.32, 0.64, 1.28)
"""Correlation times, seconds, of the smooth movements that a channel is a sum of."""
ROUNDS = 30
COMMON = 1.0
"""Windows' worth of belief that a channel moves as the take's channels do on average."""
TINY = 1e-9


def smooth_kernels(window: int, frame_rate: float) -> Array:
    """Return covariances of the waves of a window, shape (n_lengths, window, window)."""
    steps = np.subtract.outer(np.arange(window), np.arange(window)) / frame_rate
    kernels = np.exp(-0.5 * (steps / np.array(LENGTHS)[:, None, None]) ** 2)
    waves = idct(np.eye(window), axis=0, norm="ortho")
    return np.asarray(waves.T @ kernels @ waves)


def fit_smoothness(rough: Array, noise: Array, kernels: Array, windows: Windows) -> Array:
    """Return the variance at each correlation time, shape (n_lengths, n_channels).

    The likeliest, given the power of each wave (Whittle's likelihood), by multiplicative
    updates; first of all channels together, then of each.

    Parameters
    ----------
    rough : shape (n_frames, n_channels)
        Without spikes or NaN, about the channels' middle.
    noise : shape (n_channels,)
        Standard deviation of what is added to each sample.
    kernels : see `smooth_kernels`
    windows : Windows
    """
    n_waves = min(windows.length, kernels.shape[1])
    waves = windows.waves_of(windows.cut(rough, windows.starts))[:, :n_waves]
    power = (waves**2).mean(axis=0)
    white = np.broadcast_to(noise**2 / windows.density, power.shape)
    shapes = np.einsum("lkk->lk", kernels)[:, :n_waves]
    size = np.maximum(power.mean(axis=0), TINY)
    together = (power / size).mean(axis=1, keepdims=True)
    white_together = (white / size).mean(axis=1, keepdims=True)
    common = _fitted(together, white_together, shapes)
    n_windows = windows.n_frames / windows.length
    expected = size * (common.T @ shapes).T + white
    blended = (n_windows * power + COMMON * expected) / (n_windows + COMMON)
    return _fitted(blended, white, shapes)


def _fitted(power: Array, white: Array, shapes: Array) -> Array:
    """Return non-negative weights of shapes that explain the power beyond the white part."""
    weights = np.repeat(
        np.maximum(power - white, 0.05 * power).mean(axis=0)[None] / len(shapes), len(shapes), 0
    )
    for _ in range(ROUNDS):
        model = shapes.T @ weights + white + TINY
        weights *= np.sqrt((shapes @ (power / model**2)) / (shapes @ (1.0 / model) + TINY))
    return np.asarray(weights)
