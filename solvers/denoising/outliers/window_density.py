"""Density of a joint's samples in a window under each component of a mixture."""

from functools import lru_cache

import numpy as np

from ...arrays import Array, Flags
from ..motion_model import N_CHANNELS, MotionMixture

Channels = tuple[int, ...]
MAX_SAMPLE_RATIO = 4
"""Samples of a window for each coefficient up to which missing samples are integrated out, that
is up to 120 Hz. It bounds the memory of W, and the run time: with more samples the coefficients
take less of both."""


class WindowDensity:
    """The density of the observed samples of a window of a joint, for each component.

    With the cosines B of the samples, their noise N and a component's covariance C, the
    precision matrix of all samples is N^-1 - W W', where W = N^-1 B L'^-1 and L is the lower
    triangular root of C^-1 + B' N^-1 B (matrix inversion lemma). It is the same for all windows
    of a joint. Where few samples are not observed, their unknown errors are integrated out:
    only a matrix of their number has to be factored for each window. Where many are, the
    unknown coefficients of the observed ones are integrated out instead: their number does not
    grow with the frame rate.

    Parameters
    ----------
    noise : shape (3,)
        Standard deviation of each channel.
    basis : shape (length, n_coefficients)
        Cosines at the frames of a window.
    mixture : MotionMixture
        Of joints.
    axes : shape (3, 3)
        Principal axes of the joint's movement, as columns.
    """

    def __init__(self, noise: Array, basis: Array, mixture: MotionMixture, axes: Array) -> None:
        self._noise, self._basis, self._mixture, self._axes = noise, basis, mixture, axes
        self._inverses = dict[Channels, tuple[Array, Array]]()
        self._roots = dict[Channels, tuple[Array, Array]]()

    @property
    def log_weights(self) -> Array:
        """Logarithm of the weight of each component."""
        return np.log(self._mixture.weights)

    def log_marginals(
        self,
        samples: Array,
        channels: Channels,
        observed: Flags,
        offset: Flags | None = None,
        deviation: float = np.inf,
    ) -> tuple[Array, Array]:
        """Return each component's log-density of the observed samples of a window's channels.

        The second one is that with an unknown constant added to each channel in the frames of
        `offset`. The constants follow the other unknowns, so that one factorization yields
        both. If their deviation is infinite, it is the density of the frames outside `offset`.

        Parameters
        ----------
        samples : shape (length, 3), complete
        channels : tuple of int
            Those that count.
        observed, offset : shape (length, 3)
        deviation : float
            Of the constants, in the unit of the samples.
        """
        columns = list(channels)
        known = observed[:, columns].T.ravel()
        n_offsets = 0 if offset is None else len(columns)
        rows = np.zeros((n_offsets + 1, len(columns), len(observed)))
        if offset is not None:
            own = np.arange(n_offsets)
            rows[own, own] = (offset & observed)[:, columns].T
        rows[n_offsets] = samples[:, columns].T
        rows = rows.reshape(len(rows), known.size)
        n_missing = known.size - np.count_nonzero(known)
        n_coefficients = len(columns) * self._basis.shape[1]
        is_short = known.size <= MAX_SAMPLE_RATIO * n_coefficients
        are_few = 2 * n_missing < n_coefficients
        build = self._with_missing_samples if is_short and are_few else self._with_coefficients
        factored, log_density = build(channels, known, rows)
        last = factored.shape[1] - 1
        n_unknown = last - n_offsets
        own = np.arange(n_unknown, last)
        factored[:, own, own] += deviation**-2
        square = factored[:, last, last].copy()
        factored[:, last, last] += 1.0  # not below 0 by rounding
        factors = np.linalg.cholesky(factored)
        exponents = 0.5 * factors[:, last, :last] ** 2
        exponents -= np.log(np.einsum("kss->ks", factors)[:, :last].copy())
        without = log_density - 0.5 * square + exponents[:, :n_unknown].sum(axis=1)
        # An infinite deviation is a density of 1 everywhere, without the factors of a Gaussian.
        scale = np.log(deviation) if np.isfinite(deviation) else -0.5 * np.log(2.0 * np.pi)
        of_offsets = exponents[:, n_unknown:] - scale
        return without, without + of_offsets.sum(axis=1)

    def _with_missing_samples(
        self, channels: Channels, known: Flags, rows: Array
    ) -> tuple[Array, Array]:
        """Return the precision matrices of the missing samples and of the rows, and scales.

        Parameters
        ----------
        channels : tuple of int
        known : shape (n_samples,)
            Of the window, channel by channel.
        rows : shape (n_rows, n_samples)
        """
        roots, log_density = self._precision_roots(channels)
        missing = np.flatnonzero(~known)
        precision = np.repeat(self._noise[list(channels)] ** -2.0, len(self._basis))
        errors = np.zeros((len(missing), known.size))
        errors[np.arange(len(missing)), missing] = 1.0
        rows, of_rows = np.concatenate([errors, rows]), np.tensordot(rows, roots, 1)
        projected = np.concatenate([roots[missing], of_rows]).transpose(1, 0, 2)
        factored = (rows * precision) @ rows.T - projected @ projected.transpose(0, 2, 1)
        return factored, log_density + 0.5 * len(missing) * np.log(2.0 * np.pi)

    def _with_coefficients(
        self, channels: Channels, known: Flags, rows: Array
    ) -> tuple[Array, Array]:
        """Return the same of the coefficients instead of the missing samples."""
        inverses, log_scale = self._inverse_covariances(channels)
        precision = known * np.repeat(self._noise[list(channels)] ** -2.0, len(self._basis))
        columns = np.hstack([np.kron(np.eye(len(channels)), self._basis), rows.T])
        products = (columns.T * precision) @ columns
        factored = np.repeat(products[None], len(inverses), axis=0)
        size = inverses.shape[1]
        factored[:, :size, :size] += inverses
        return factored, log_scale + 0.5 * np.log(precision[known] / (2.0 * np.pi)).sum()

    def _precision_roots(self, channels: Channels) -> tuple[Array, Array]:
        """Return W, shape (n_samples, n_components, n_coefficients), and the log-density at 0.

        Of all samples of a window, channel by channel.
        """
        if channels not in self._roots:
            inverses, log_weights = self._inverse_covariances(channels)
            precision = np.diag(self._noise[list(channels)] ** -2.0)
            factors = np.linalg.cholesky(
                inverses + np.kron(precision, self._basis.T @ self._basis)
            )
            weighted = np.kron(precision, self._basis)
            inverted = np.linalg.inv(factors).transpose(2, 0, 1).reshape(weighted.shape[1], -1)
            roots = weighted @ inverted
            log_scale = np.log(np.einsum("kss->ks", factors).copy()).sum(axis=1)
            log_scale += 0.5 * len(self._basis) * np.log(2.0 * np.pi / np.diag(precision)).sum()
            roots = roots.reshape(len(weighted), *factors.shape[:2])
            self._roots[channels] = roots, log_weights - log_scale
        return self._roots[channels]

    def _inverse_covariances(self, channels: Channels) -> tuple[Array, Array]:
        """Return each component's inverse covariance, and the log of its weight and scale."""
        if channels not in self._inverses:
            self._inverses[channels] = self._invert_covariances(channels)
        return self._inverses[channels]

    def _invert_covariances(self, channels: Channels) -> tuple[Array, Array]:
        axes = self._axes[list(channels)]
        if len(channels) == N_CHANNELS:
            inverses, log_scale = _invert_axes(self._mixture)
            return _in_channels(inverses, axes), self.log_weights - log_scale
        covariances = _in_channels(self._mixture.covariances, axes)
        log_scale = 0.5 * np.linalg.slogdet(covariances)[1]
        return np.linalg.inv(covariances), self.log_weights - log_scale


@lru_cache(maxsize=4)
def _invert_axes(mixture: MotionMixture) -> tuple[Array, Array]:
    """Return the inverse covariances of each axis, and the components' log of the scale."""
    log_scale = 0.5 * np.linalg.slogdet(mixture.covariances)[1].sum(axis=1)
    return np.linalg.inv(mixture.covariances), log_scale


def _in_channels(matrices: Array, axes: Array) -> Array:
    """Convert matrices from principal axes to channels, shape (n_components, size, size).

    Parameters
    ----------
    matrices : shape (n_components, 3, n_coefficients, n_coefficients)
    axes : shape (n_channels, 3)
    """
    n_components, _, n, _ = matrices.shape
    products = np.einsum("ca,da->cda", axes, axes).reshape(-1, N_CHANNELS)
    mixed = products @ matrices.reshape(n_components, N_CHANNELS, -1)
    mixed = mixed.reshape(n_components, len(axes), len(axes), n, n).transpose(0, 1, 3, 2, 4)
    return np.asarray(mixed.reshape(n_components, len(axes) * n, len(axes) * n))
