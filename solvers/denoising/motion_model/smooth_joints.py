"""Smooth every joint of a complete take by the mixture of windows."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ..channels import Smoothed
from ..window_priors import Windows
from .motion_mixture import N_CHANNELS, MotionMixture
from .principal_axes import principal_axes

MAX_LEVERAGE = 1.0 - 1e-9
"""Largest weight of a sample in its own estimate. Guards a division."""
N_OVERLAPS = 8
"""Number of windows that start within the length of one. Chosen by hand; `make sensitivity`
varies it."""
MAX_BLOCK_WINDOWS = 64
"""Windows processed at a time: this bounds the memory, however long the take."""


class _Basis(NamedTuple):
    """The eigenvectors of all covariances of a mixture: each component is diagonal in them."""

    vectors: Array
    """Of each axis, shape (3, n_coefficients, n_components * n_coefficients)."""
    variances: Array
    """Square degrees along them, shape (3, n_components, n_coefficients)."""
    squares: Array
    """Of their frames, shape (3, n_components, n_coefficients, length)."""


class _JointFilters(NamedTuple):
    """The filters of one joint, one for each component."""

    total: Array
    """Variance of movement and noise along each eigenvector, like `_Basis.variances`."""
    gains: Array
    """Fraction of it that is movement."""
    log_density: Array
    """At zero, without constants, with the component's weight, shape (n_components,)."""
    leverage: Array
    """Weight of each sample in its own estimate, shape (n_components, 3, length)."""


@dataclass(frozen=True, eq=False)
class MixtureSmoother:
    """Estimate every joint from its own window of half a second.

    The estimate of a window is the posterior mean under the mixture [1]_; overlapping windows
    are averaged. The mixture distinguishes a fast moment from a still one, so that the first is
    smoothed less than the second. Each joint is smoothed along the principal axes of its
    movement, where every component is a product of filters of one axis.

    Attributes
    ----------
    noise : shape (n_joints, 3, 3)
        Covariances, square degrees or centimeters; see `JointNoise`.
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
        average, shape = samples.mean(axis=0), (len(samples), -1, N_CHANNELS)
        centered = (samples - average).reshape(shape)
        axes = principal_axes(centered, self.noise)
        along_axes = np.einsum("tjc,jac->tja", centered, axes.from_channels)
        filters = [self._build_filters(variance / self._density) for variance in axes.variance]
        smoothed, leverage = (
            each.reshape(shape)
            for each in self._average_windows(along_axes.reshape(samples.shape), filters)
        )
        values = np.einsum("tja,jca->tjc", smoothed, axes.to_channels).reshape(samples.shape)
        values += average
        freedom = np.einsum("tja,ja,jca->tjc", leverage, axes.variance, axes.to_channels**2)
        freedom = freedom.reshape(samples.shape)
        variance = np.einsum("jcc->jc", self.noise).ravel()
        leverage = np.minimum(freedom / variance, MAX_LEVERAGE)
        return Smoothed(values, (samples - values) / (1.0 - leverage), freedom)

    def _average_windows(
        self, samples: Array, filters: Sequence[_JointFilters]
    ) -> tuple[Array, Array]:
        """Return the smoothed samples and their leverage, means over overlapping windows.

        Parameters
        ----------
        samples : shape (n_frames, 3 n_joints)
            Along the principal axes.
        filters : sequence of _JointFilters, length n_joints
        """
        windows = Windows(len(samples), self._length, self._density, N_OVERLAPS)
        total, leverage = np.zeros_like(samples), np.zeros_like(samples)
        weight = np.zeros((len(samples), 1))
        windows.add(weight, np.ones((windows.length, 1)), windows.starts)
        for first in range(0, len(windows.starts), MAX_BLOCK_WINDOWS):
            starts = windows.starts[first : first + MAX_BLOCK_WINDOWS]
            frames = windows.extract(samples, starts).transpose(0, 2, 1)
            coefficients = frames @ self._cosines / self._density
            leverages = np.empty_like(frames)
            for joint, own in enumerate(filters):
                channels = slice(N_CHANNELS * joint, N_CHANNELS * (joint + 1))
                coefficients[:, channels], responsibility = self._smooth(
                    coefficients[:, channels], own
                )
                leverages[:, channels] = np.tensordot(responsibility, own.leverage, 1)
            smoothed = coefficients @ self._cosines.T
            windows.add(total, smoothed.transpose(0, 2, 1), starts)
            windows.add(leverage, leverages.transpose(0, 2, 1), starts)
        return total / weight, leverage / weight

    @property
    def _density(self) -> float:
        """Frames of the take per frame of the mixture."""
        return self.frame_rate / self.mixture.frame_rate

    @property
    def _length(self) -> int:
        """Frames of a window."""
        return round(self.mixture.window * self._density)

    @cached_property
    def _cosines(self) -> Array:
        windows = Windows(self._length, self._length, self._density)
        return windows.dct_basis(self.mixture.truncated(self._length).window)

    @cached_property
    def _basis(self) -> _Basis:
        covariances = self.mixture.truncated(self._length).covariances
        variances, vectors = np.linalg.eigh(covariances.transpose(1, 0, 2, 3))
        frames = self._cosines / np.sqrt(self._density) @ vectors
        by_coefficient = vectors.transpose(0, 2, 1, 3)
        by_coefficient = by_coefficient.reshape(*by_coefficient.shape[:2], -1)
        return _Basis(by_coefficient, variances, np.square(frames).transpose(0, 1, 3, 2))

    def _build_filters(self, variance: Array) -> _JointFilters:
        """Return a joint's filters for this noise of the coefficients of each axis."""
        basis = self._basis
        total = basis.variances + variance[:, None, None]
        gains = basis.variances / total
        log_density = np.log(self.mixture.weights) - 0.5 * np.log(total).sum(axis=(0, 2))
        leverage = (gains[:, :, None] @ basis.squares)[:, :, 0].transpose(1, 0, 2)
        return _JointFilters(total, gains, log_density, leverage)

    def _smooth(self, coefficients: Array, filters: _JointFilters) -> tuple[Array, Array]:
        """Return a joint's posterior mean coefficients, and the components' probabilities.

        Parameters
        ----------
        coefficients : shape (n_windows, 3, n_coefficients)
        filters : _JointFilters
        """
        vectors, n_windows = self._basis.vectors, len(coefficients)
        projected = coefficients.transpose(1, 0, 2) @ vectors
        n_components, n_coefficients = filters.total.shape[1:]
        each = projected.reshape(N_CHANNELS, n_windows, n_components, n_coefficients)
        exponents = np.einsum("awkn,akn->wk", each**2, 1.0 / filters.total)
        log_density = filters.log_density - 0.5 * exponents
        density = np.exp(log_density - log_density.max(axis=1, keepdims=True))
        responsibility = density / density.sum(axis=1, keepdims=True)
        # In place: a view of `projected`.
        each *= filters.gains[:, None]
        each *= responsibility[..., None]
        return (projected @ vectors.transpose(0, 2, 1)).transpose(1, 0, 2), responsibility
