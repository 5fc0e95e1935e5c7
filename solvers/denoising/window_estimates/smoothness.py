"""Fit how fast the channels of a take move, from the take itself."""

import numpy as np

from ...arrays import Array
from ..window_priors import Windows

CORRELATION_TIMES_S = (0.08, 0.16, 0.32, 0.64, 1.28)
"""Correlation times, seconds, of the smooth movements whose sum is a channel. Half and twice
are no better (`make sensitivity`)."""
N_UPDATES = 30
"""Multiplicative updates of the weights. It bounds the run time."""
POOLED_WINDOWS = 1.0
"""Weight, in windows, of the assumption that a channel moves like the take's average channel.
Half and twice gain less than 1 % (`make sensitivity`)."""
MIN_POWER = 1e-9
"""Square degrees or centimeters added to each power. Guards a division."""


def build_smooth_kernels(window: int, frame_rate: float) -> Array:
    """Return covariances of the DCT coefficients, shape (n_times, window, window)."""
    steps = np.subtract.outer(np.arange(window), np.arange(window)) / frame_rate
    kernels = np.exp(-0.5 * (steps / np.array(CORRELATION_TIMES_S)[:, None, None]) ** 2)
    coefficients = Windows(window, window, 1.0).dct_basis(window)
    return np.asarray(coefficients.T @ kernels @ coefficients)


def fit_smoothness(rough: Array, noise: Array, kernels: Array, windows: Windows) -> Array:
    """Return the variance at each correlation time, shape (n_times, n_channels).

    It maximizes Whittle's likelihood of each coefficient's power by multiplicative updates,
    first for all channels together, then for each.

    Parameters
    ----------
    rough : shape (n_frames, n_channels)
        Without spikes or NaN, about the channels' mean.
    noise : shape (n_channels,)
        Standard deviation of the noise of each sample.
    kernels : see `build_smooth_kernels`
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
    """Return non-negative weights of the spectra that explain the power beyond the noise."""
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
