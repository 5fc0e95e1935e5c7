"""Smooth every joint of a complete take by the mixture of windows."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dpotrf, dpotri

from ...arrays import Array
from ..channels import Smoothed
from ..window_priors import Windows
from .motion_mixture import N_CHANNELS, MotionMixture

MAX_LEVERAGE = 1.0 - 1e-9
"""Largest weight of a sample in its own estimate. Guards a division."""
N_OVERLAPS = 8
"""Number of windows that start within the length of one. Chosen by hand; `make sensitivity`
varies it."""
MAX_BLOCK_WINDOWS = 64
"""Windows processed at a time: this bounds the memory, however long the take."""


class _JointFilters(NamedTuple):
    """The filters of one joint, one for each component."""

    inverse: Array
    """Of the covariance with noise, shape (n_components, size, size)."""
    log_density: Array
    """At zero, without constants, with the component's weight, shape (n_components,)."""
    leverage: Array
    """Weight of each sample in its own estimate, shape (n_components, 3 * length)."""


@dataclass(frozen=True, eq=False)
class MixtureSmoother:
    """Estimate every joint from its own window of half a second.

    The estimate of a window is the posterior mean under the mixture [1]_; overlapping windows
    are averaged. The mixture distinguishes a fast moment from a still one, so that the first is
    smoothed less than the second. The filters follow from the noise alone: several takes of the
    same noise share them.

    Attributes
    ----------
    noise : shape (n_channels,)
        Standard deviation, degrees or centimeters; see `estimate_channel_noise`.
    frame_rate : float, Hz
    mixture : MotionMixture

    References
    ----------
    .. [1] Zoran, Weiss (2011). From learning models of natural image patches to whole image
       restoration. ICCV. doi:10.1109/ICCV.2011.6126278
    """

    noise: Array
    frame_rate: float
    mixture: MotionMixture

    def __call__(self, samples: Array) -> Smoothed | None:
        """Return the smoothed take; None if it is shorter than a window.

        Parameters
        ----------
        samples : shape (n_frames, n_channels), without NaN
            Degrees, or centimeters of the root; each joint has three channels.
        """
        if len(samples) < self._length:
            return None
        windows = Windows(len(samples), self._length, self._density, N_OVERLAPS)
        total, leverage = np.zeros_like(samples), np.zeros_like(samples)
        weight, average = np.zeros((len(samples), 1)), samples.mean(axis=0)
        centered = samples - average
        windows.add(weight, np.ones((windows.length, 1)), windows.starts)
        for first in range(0, len(windows.starts), MAX_BLOCK_WINDOWS):
            starts = windows.starts[first : first + MAX_BLOCK_WINDOWS]
            frames = windows.extract(centered, starts).transpose(0, 2, 1)
            coefficients = frames @ self._basis / self._density
            joints = coefficients.reshape(len(starts), len(self._filters), -1)
            leverages = np.empty_like(frames)
            for joint, filters in enumerate(self._filters):
                channels = slice(N_CHANNELS * joint, N_CHANNELS * (joint + 1))
                solved, responsibility = _solve(joints[:, joint], filters)
                coefficients[:, channels] -= self._variance[channels, None] * solved.reshape(
                    len(starts), N_CHANNELS, -1
                )
                leverages[:, channels] = (responsibility @ filters.leverage).reshape(
                    len(starts), N_CHANNELS, -1
                )
            smoothed = coefficients @ self._basis.T
            windows.add(total, smoothed.transpose(0, 2, 1), starts)
            windows.add(leverage, leverages.transpose(0, 2, 1), starts)
        values, leverage = average + total / weight, np.minimum(leverage / weight, MAX_LEVERAGE)
        return Smoothed(values, (samples - values) / (1.0 - leverage), leverage * self.noise**2)

    @property
    def _density(self) -> float:
        """Frames of the take per frame of the mixture."""
        return self.frame_rate / self.mixture.frame_rate

    @property
    def _length(self) -> int:
        """Frames of a window."""
        return round(self.mixture.window * self._density)

    @property
    def _variance(self) -> Array:
        """Of the noise of a coefficient of each channel."""
        return self.noise**2 / self._density

    @cached_property
    def _basis(self) -> Array:
        mixture = self.mixture.truncated(self._length)
        windows = Windows(self._length, self._length, self._density)
        return windows.dct_basis(mixture.window)

    @cached_property
    def _filters(self) -> list[_JointFilters]:
        """The filters of each joint; joints of the same noise share them."""
        mixture = self.mixture.truncated(self._length)
        basis = self._basis / np.sqrt(self._density)
        variances, same = np.unique(
            self._variance.reshape(-1, N_CHANNELS), axis=0, return_inverse=True
        )
        filters = [_build_filters(mixture, variance, basis) for variance in variances]
        return [filters[index] for index in same.ravel()]


def _solve(coefficients: Array, filters: _JointFilters) -> tuple[Array, Array]:
    """Return the mean inverse times the coefficients, and the components' probabilities.

    Parameters
    ----------
    coefficients : shape (n_windows, size)
        Of one joint.
    filters : _JointFilters
    """
    solved = coefficients @ filters.inverse
    exponents = np.einsum("kws,ws->wk", solved, coefficients)
    log_density = filters.log_density - 0.5 * exponents
    density = np.exp(log_density - log_density.max(axis=1, keepdims=True))
    responsibility = density / density.sum(axis=1, keepdims=True)
    return np.einsum("wk,kws->ws", responsibility, solved), responsibility


def _build_filters(mixture: MotionMixture, variance: Array, basis: Array) -> _JointFilters:
    """Return the filters for the noise of the coefficients of each of the three channels.

    Parameters
    ----------
    mixture : MotionMixture
    variance : shape (3,)
    basis : shape (length, n_coefficients), orthonormal
    """
    n = mixture.window
    inverse = mixture.covariances + np.diag(np.repeat(variance, n))
    # In place, and one triangle only: half the time of numpy's inverse.
    for matrix in inverse:
        dpotrf(matrix.T, lower=1, clean=0, overwrite_a=1)
    log_scale = np.log(np.einsum("kii->ki", inverse)).sum(axis=1)
    for matrix in inverse:
        dpotri(matrix.T, lower=1, overwrite_c=1)
    rows, columns = np.tril_indices(N_CHANNELS * n, -1)
    inverse[:, rows, columns] = inverse[:, columns, rows]
    blocks = inverse.reshape(-1, N_CHANNELS, n, N_CHANNELS, n)
    own = np.eye(n) - variance[:, None, None] * np.einsum("kcicj->kcij", blocks)
    products = np.einsum("ti,tj->ijt", basis, basis).reshape(n * n, -1)
    leverage = own.reshape(-1, n * n) @ products
    log_density = np.log(mixture.weights) - log_scale
    return _JointFilters(inverse, log_density, leverage.reshape(len(inverse), -1))
