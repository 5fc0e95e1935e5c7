"""Smooth every joint of a complete take by the mixture of windows."""

from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ..channels import Smoothed
from ..window_priors import Windows
from .motion_mixture import N_CHANNELS, MotionMixture

MAX_LEVERAGE = 1.0 - 1e-9
"""Largest weight of a sample in its own estimate. Guards a division."""
N_OVERLAPS = 8
"""Number of windows that start within the length of one. Chosen by hand: x0.5 gains 0.1 %, x2
costs nothing."""
MAX_BLOCK_WINDOWS = 512
"""Windows processed at a time: this bounds the memory, however long the take."""


class _JointFilters(NamedTuple):
    """The filters of one joint, one for each component."""

    inverse: Array
    """Of the covariance with noise, shape (n_components, size, size)."""
    log_scale: Array
    """Log-density at zero, without constants, shape (n_components,)."""
    leverage: Array
    """Weight of each sample in its own estimate, shape (n_components, length, 3)."""


def smooth_by_mixture(
    samples: Array, noise: Array, frame_rate: float, mixture: MotionMixture
) -> Smoothed | None:
    """Estimate every joint from its own window of half a second.

    The estimate of a window is the posterior mean under the mixture [1]_; overlapping windows
    are averaged. The mixture distinguishes a fast moment from a still one, so that the first is
    smoothed less than the second.

    Parameters
    ----------
    samples : shape (n_frames, n_channels), without NaN
        Degrees, or centimeters of the root; each joint has three channels.
    noise : shape (n_channels,)
        Standard deviation; see `estimate_channel_noise`.
    frame_rate : float, Hz
    mixture : MotionMixture

    Returns
    -------
    Smoothed or None
        None if the take is shorter than a window.

    References
    ----------
    .. [1] Zoran, Weiss (2011). From learning models of natural image patches to whole image
       restoration. ICCV. doi:10.1109/ICCV.2011.6126278
    """
    density = frame_rate / mixture.frame_rate
    length = round(mixture.window * density)
    if len(samples) < length:
        return None
    mixture = mixture.truncated(length)
    windows = Windows(len(samples), length, density, N_OVERLAPS)
    mean = samples.mean(axis=0)
    smoothed = _smooth(samples - mean, noise, windows, mixture)
    return smoothed._replace(values=smoothed.values + mean)


def _smooth(samples: Array, noise: Array, windows: Windows, mixture: MotionMixture) -> Smoothed:
    """Smooth samples about their mean, with this noise of each channel."""
    total, leverage = np.zeros_like(samples), np.zeros_like(samples)
    weight = np.zeros((len(samples), 1))
    windows.add(weight, np.ones((windows.length, 1)), windows.starts)
    basis = windows.dct_basis(mixture.window)
    log_weights = np.log(mixture.weights)
    for first in range(0, samples.shape[1], N_CHANNELS):
        joint = slice(first, first + N_CHANNELS)
        scale = np.repeat(noise[joint] / np.sqrt(windows.density), mixture.window)
        gains = _gains(mixture, scale, basis / np.sqrt(windows.density))
        for block in range(0, len(windows.starts), MAX_BLOCK_WINDOWS):
            starts = windows.starts[block : block + MAX_BLOCK_WINDOWS]
            frames = windows.extract(samples[:, joint], starts)
            coefficients = windows.coefficients_from_frames(frames)[:, : mixture.window]
            flat = coefficients.transpose(0, 2, 1).reshape(len(starts), -1)
            solved = flat @ gains.inverse
            log_density = log_weights + gains.log_scale
            log_density = log_density - 0.5 * np.einsum("ws,kws->wk", flat, solved)
            density = np.exp(log_density - log_density.max(axis=1, keepdims=True))
            responsibility = density / density.sum(axis=1, keepdims=True)
            mean = flat - scale**2 * np.einsum("wk,kws->ws", responsibility, solved)
            mean = mean.reshape(len(starts), N_CHANNELS, -1).transpose(0, 2, 1)
            windows.add(total[:, joint], basis @ mean, starts)
            windows.add(
                leverage[:, joint],
                np.einsum("wk,ktc->wtc", responsibility, gains.leverage),
                starts,
            )
    values, leverage = total / weight, np.minimum(leverage / weight, MAX_LEVERAGE)
    return Smoothed(values, (samples - values) / (1.0 - leverage), leverage * noise**2)


def _gains(mixture: MotionMixture, scale: Array, basis: Array) -> _JointFilters:
    """Return the filters for this noise of each coefficient; the basis is orthonormal."""
    noisy = mixture.covariances + np.diag(scale**2)
    inverse = np.linalg.inv(noisy)
    gain = np.eye(len(scale)) - scale[:, None] ** 2 * inverse
    blocks = gain.reshape(len(gain), N_CHANNELS, mixture.window, N_CHANNELS, mixture.window)
    own = np.einsum("kcicj->kcij", blocks)
    leverage = np.einsum("ti,kcij,tj->ktc", basis, own, basis, optimize=True)
    return _JointFilters(inverse, -0.5 * np.linalg.slogdet(noisy)[1], leverage)
