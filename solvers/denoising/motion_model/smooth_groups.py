"""Smooth joints, each alone or with its parent, by a mixture of windows."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy

from ...arrays import Array
from ..window_priors import WHITE, NoiseSpectrum, Windows
from .motion_mixture import MotionMixture
from .principal_axes import principal_axes

N_OVERLAPS = 4
"""Number of windows that start within the length of one. Sweep on the development takes of the
first press: 3 cost 0.1 %, 8 change less than that in twice the time."""
MAX_BLOCK_WINDOWS = 64
"""Windows processed at a time: this bounds the memory, however long the take."""


class _Basis(NamedTuple):
    """The eigenvectors of all covariances of a mixture: each component is diagonal in them."""

    vectors: Array
    """Of each axis, shape (n_axes, n_coefficients, n_components * n_coefficients)."""
    variances: Array
    """Square degrees along them, shape (n_axes, n_components, n_coefficients)."""
    squares: Array
    """Of their frames, shape (n_axes, n_components, n_coefficients, length)."""


class _Transform(NamedTuple):
    """From the frames of a window to coefficients whose noise is white, and back."""

    to_coefficients: Array
    """Shape (length, n_coefficients)."""
    to_frames: Array
    """Shape (n_coefficients, length)."""
    deviations: Array
    """Of the noise, relative to that of a sample, shape (n_coefficients,)."""


class _GroupFilters(NamedTuple):
    """The filters of one group, one for each component."""

    gains: Array
    """Fraction of the variance along each eigenvector that is movement, like
    `_Basis.variances`."""
    factors: Array
    """Inverse of this variance, and the square of the gain, on the last axis."""
    log_density: Array
    """At zero, without constants, with the component's weight, shape (n_components,)."""
    leverage: Array
    """Variance of the error relative to the noise: with white noise the weight of each sample
    in its own estimate. Shape (n_components, n_axes, length)."""
    noise: Array
    """Variance of the coefficients' noise, shape (n_axes,)."""


@dataclass(frozen=True, eq=False)
class GroupSmoother:
    """Estimate joints from their own window of half a second.

    The estimate of a window is the posterior mean under the mixture [1]_; overlapping windows
    are averaged. The mixture distinguishes a fast moment from a still one, so that the first is
    smoothed less than the second. The joints of a group are smoothed along the principal axes
    of their movement, where every component is a product of filters of one axis.

    Attributes
    ----------
    noise : shape (n_groups, n_axes, n_axes)
        Covariances, square degrees or centimeters.
    frame_rate : float, Hz
    mixture : MotionMixture
    noise_spectrum : NoiseSpectrum
    n_ignored : int
        Number of the slowest coefficients that do not count.

    References
    ----------
    .. [1] Zoran, Weiss (2011). From learning models of natural image patches to whole image
       restoration. ICCV. doi:10.1109/ICCV.2011.6126278
    """

    noise: Array
    frame_rate: float
    mixture: MotionMixture
    noise_spectrum: NoiseSpectrum = WHITE
    n_ignored: int = 0

    def __call__(self, samples: Array) -> tuple[Array, Array]:
        """Return the smoothed samples, and the variance of their error.

        Parameters
        ----------
        samples : shape (n_frames, n_groups, n_axes)
            About their mean, without NaN; a window or longer.
        """
        axes = principal_axes(samples, self.noise)
        along_axes = np.einsum("tjc,jac->tja", samples, axes.from_channels)
        filters = [self._build_filters(variance / self._density) for variance in axes.variance]
        smoothed, leverage = (
            each.reshape(samples.shape)
            for each in self._average_windows(along_axes.reshape(len(samples), -1), filters)
        )
        values = np.einsum("tja,jca->tjc", smoothed, axes.to_channels)
        variance = np.einsum("tja,ja,jca->tjc", leverage, axes.variance, axes.to_channels**2)
        return values, variance

    def log_likelihoods(self, samples: Array, windows: Windows, factors: Array) -> Array:
        """Return how likely each window is if its noise has these factors.

        Parameters
        ----------
        samples : shape (n_frames, n_groups, n_axes)
            About their mean, without NaN; a window or longer.
        windows : Windows
        factors : shape (n_factors,)
            Of the standard deviation of the noise.

        Returns
        -------
        shape (n_windows, n_groups, n_factors)
            Logarithms, without constants.
        """
        axes, basis = principal_axes(samples, self.noise), self._basis
        of_units = axes.variance.shape[1] * np.log(self._transform.deviations).sum()
        along_axes = np.einsum("tjc,jac->tja", samples, axes.from_channels)
        along_axes = along_axes.reshape(len(samples), -1)
        found = np.empty((len(windows.starts), len(self.noise), len(factors)))
        for first in range(0, len(found), MAX_BLOCK_WINDOWS):
            block = slice(first, first + MAX_BLOCK_WINDOWS)
            frames = windows.extract(along_axes, windows.starts[block]).transpose(0, 2, 1)
            coefficients = frames @ self._transform.to_coefficients
            coefficients = coefficients.reshape(len(frames), *axes.variance.shape, -1)
            for group, variance in enumerate(axes.variance / self._density):
                projected = coefficients[:, group].transpose(1, 0, 2) @ basis.vectors
                squares = np.square(projected)
                squares = squares.reshape(*projected.shape[:2], *basis.variances.shape[1:])
                noise = np.square(factors)[:, None] * variance
                total = basis.variances + noise[..., None, None]
                log_density = _log_density(squares, total, self._density_at_zero(total))
                found[block, group] = scipy.special.logsumexp(log_density, axis=0)
        return np.asarray(found - of_units)

    def windows(self, n_frames: int, n_overlaps: int = N_OVERLAPS) -> Windows:
        """Return the windows of a take."""
        return Windows(
            n_frames, self.length, self._density, n_overlaps, noise_spectrum=self.noise_spectrum
        )

    def _average_windows(
        self, samples: Array, filters: Sequence[_GroupFilters]
    ) -> tuple[Array, Array]:
        """Return the smoothed samples and their leverage, means over overlapping windows.

        Parameters
        ----------
        samples : shape (n_frames, n_groups n_axes)
            Along the principal axes.
        filters : sequence of _GroupFilters, length n_groups
        """
        windows, n_axes = self.windows(len(samples)), self.noise.shape[1]
        total, leverage = np.zeros_like(samples), np.zeros_like(samples)
        weight = np.zeros((len(samples), 1))
        windows.add(weight, np.ones((windows.length, 1)), windows.starts)
        for first in range(0, len(windows.starts), MAX_BLOCK_WINDOWS):
            starts = windows.starts[first : first + MAX_BLOCK_WINDOWS]
            frames = windows.extract(samples, starts).transpose(0, 2, 1)
            coefficients = frames @ self._transform.to_coefficients
            leverages = np.empty_like(frames)
            for group, own in enumerate(filters):
                channels = slice(n_axes * group, n_axes * (group + 1))
                coefficients[:, channels], responsibility, spread = self._smooth(
                    coefficients[:, channels], own
                )
                leverages[:, channels] = np.tensordot(responsibility, own.leverage, 1)
                leverages[:, channels] += spread[..., None] / self.length
            smoothed = coefficients @ self._transform.to_frames
            windows.add(total, smoothed.transpose(0, 2, 1), starts)
            windows.add(leverage, leverages.transpose(0, 2, 1), starts)
        return total / weight, leverage / weight

    @property
    def _density(self) -> float:
        """Frames of the take per frame of the mixture."""
        return self.frame_rate / self.mixture.frame_rate

    @property
    def length(self) -> int:
        """Frames of a window."""
        return round(self.mixture.window * self._density)

    @cached_property
    def _transform(self) -> _Transform:
        windows, size = self.windows(self.length), self.mixture.truncated(self.length).window
        to_frames = windows.dct_basis(size)[:, self.n_ignored :]
        deviations = windows.noise_deviations[self.n_ignored : size]
        to_coefficients = to_frames / np.square(deviations) / self._density
        return _Transform(to_coefficients, to_frames.T, deviations)

    @cached_property
    def _basis(self) -> _Basis:
        transform = self._transform
        deviations = transform.deviations
        covariances = self.mixture.truncated(self.length).covariances
        covariances = covariances[..., self.n_ignored :, self.n_ignored :]
        covariances = covariances / np.outer(deviations, deviations)
        variances, vectors = np.linalg.eigh(covariances.transpose(1, 0, 2, 3))
        frames = transform.to_frames.T / np.sqrt(self._density) @ vectors
        by_coefficient = vectors.transpose(0, 2, 1, 3)
        by_coefficient = by_coefficient.reshape(*by_coefficient.shape[:2], -1)
        return _Basis(by_coefficient, variances, np.square(frames).transpose(0, 1, 3, 2))

    def _build_filters(self, variance: Array) -> _GroupFilters:
        """Return a group's filters for this noise of the coefficients of each axis."""
        basis = self._basis
        total = basis.variances + variance[:, None, None]
        gains = basis.variances / total
        leverage = (gains[:, :, None] @ basis.squares)[:, :, 0].transpose(1, 0, 2)
        factors = np.stack([1.0 / total, gains**2], axis=-1)
        return _GroupFilters(gains, factors, self._density_at_zero(total), leverage, variance)

    def _density_at_zero(self, total: Array) -> Array:
        """Return the log-density of each component at zero: `_GroupFilters.log_density`."""
        return np.asarray(np.log(self.mixture.weights) - 0.5 * np.log(total).sum(axis=(-3, -1)))

    def _smooth(
        self, coefficients: Array, filters: _GroupFilters
    ) -> tuple[Array, Array, Array]:
        """Return a group's posterior mean coefficients, and how far they follow noise.

        The weight of samples in their own estimate is their posterior variance, relative to
        the noise, for given axes (Tweedie's formula [1]_). It has two parts: the mean variance
        of the components, which follows from their probabilities, and that of their means.

        Parameters
        ----------
        coefficients : shape (n_windows, n_axes, n_coefficients)
        filters : _GroupFilters

        Returns
        -------
        coefficients
        responsibility : shape (n_windows, n_components)
            Probability of each component.
        spread : shape (n_windows, n_axes)
            Sum over a window of the variance of the means, relative to the noise.

        References
        ----------
        .. [1] Efron (2011). Tweedie's formula and selection bias. Journal of the American
           Statistical Association 106. doi:10.1198/jasa.2011.tm11181
        """
        vectors, n_windows = self._basis.vectors, len(coefficients)
        projected = coefficients.transpose(1, 0, 2) @ vectors
        n_components, n_coefficients = filters.gains.shape[1:]
        each = projected.reshape(len(projected), n_windows, n_components, n_coefficients)
        squares = np.square(each).transpose(0, 2, 1, 3) @ filters.factors
        log_density = filters.log_density - 0.5 * squares[..., 0].sum(axis=0).T
        density = np.exp(log_density - log_density.max(axis=1, keepdims=True))
        responsibility = density / density.sum(axis=1, keepdims=True)
        each *= responsibility[..., None]  # in place: a view of `projected`
        # There are fewer coefficients than windows.
        filtered = vectors * filters.gains.reshape(len(vectors), 1, -1)
        means = (projected @ filtered.transpose(0, 2, 1)).transpose(1, 0, 2)
        power = np.einsum("akw,wk->wa", squares[..., 1], responsibility)
        spread = (power - np.square(means).sum(axis=-1)) / filters.noise
        spread *= np.square(self._transform.deviations).mean()
        return means, responsibility, spread


def _log_density(squares: Array, total: Array, density_at_zero: Array) -> Array:
    """Return the log-density of each window under each component, with the latter's weight.

    Parameters
    ----------
    squares : shape (n_axes, n_windows, n_components, n_coefficients)
        Of the coefficients along the eigenvectors.
    total : shape (n_factors, n_axes, n_components, n_coefficients)
        Variance along them, for each factor of the noise.
    density_at_zero : shape (n_factors, n_components)

    Returns
    -------
    shape (n_components, n_windows, n_factors)
    """
    n_axes, _, n_components, n_coefficients = squares.shape
    shape = n_components, -1, n_axes * n_coefficients
    of_windows = squares.transpose(2, 1, 0, 3).reshape(shape)
    inverses = (1.0 / total).transpose(2, 0, 1, 3).reshape(shape)
    exponents = of_windows @ inverses.transpose(0, 2, 1)
    return np.asarray(density_at_zero.T[:, None] - 0.5 * exponents)
