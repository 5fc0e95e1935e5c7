"""How fast the channels of a take move, told by the take itself."""

import numpy as np
from numpy.typing import NDArray
from scipy.fft import idct

from .windows import Windows

Array = NDArray[np.float64]

CORRELATION_TIMES_S = (0.08, 0.16, 0.32, 0.64, 1.28)
"""Correlation times, seconds, of the smooth movements that a channel is a sum of."""
N_UPDATES = 30
POOLED_WINDOWS = 1.0
"""Windows' worth of belief that a channel moves as the take's channels do on average."""
MIN_POWER = 1e-9


def build_smooth_kernels(window: int, frame_rate: float) -> Array:
    """Return covariances of the waves of a window, shape (n_lengths, window, window)."""
    steps = np.subtract.outer(np.arange(window), np.arange(window)) / frame_rate
    kernels = np.exp(-0.5 * (steps / np.array(CORRELATION_TIMES_S)[:, None, None]) ** 2)
    coefficients = idct(np.eye(window), axis=0, norm="ortho")
    return np.asarray(coefficients.T @ kernels @ coefficients)


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
    n_coefficients = min(windows.length, kernels.shape[1])
    coefficients = windows.coefficients_from_frames(windows.extract(rough, windows.starts))[
        :, :n_coefficients
    ]
    power = (coefficients**2).mean(axis=0)
    noise_power = np.broadcast_to(noise**2 / windows.density, power.shape)
    spectra = np.einsum("lkk->lk", kernels)[:, :n_coefficients]
    size = np.maximum(power.mean(axis=0), MIN_POWER)
    pooled_power = (power / size).mean(axis=1, keepdims=True)
    pooled_noise = (noise_power / size).mean(axis=1, keepdims=True)
    pooled_weights = _fit_weights(pooled_power, pooled_noise, spectra)
    n_windows = windows.n_frames / windows.length
    expected_power = size * (pooled_weights.T @ spectra).T + noise_power
    blended_power = (n_windows * power + POOLED_WINDOWS * expected_power) / (
        n_windows + POOLED_WINDOWS
    )
    return _fit_weights(blended_power, noise_power, spectra)


def _fit_weights(power: Array, noise_power: Array, spectra: Array) -> Array:
    """Return non-negative weights of shapes that explain the power beyond the white part."""
    weights = np.repeat(
        np.maximum(power - noise_power, 0.05 * power).mean(axis=0)[None] / len(spectra),
        len(spectra),
        0,
    )
    for _ in range(N_UPDATES):
        model = spectra.T @ weights + noise_power + MIN_POWER
        weights *= np.sqrt(
            (spectra @ (power / model**2)) / (spectra @ (1.0 / model) + MIN_POWER)
        )
    return np.asarray(weights)
