"""Likelihood of samples of a joint, given the other samples of their window."""

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ..motion_model import N_CHANNELS, MotionMixture
from ..window_priors import Windows
from .single_outliers import OUTLIER_DENSITY

OFFSET_DEVIATION = 0.5 / OUTLIER_DENSITY / np.sqrt(3.0)
"""Standard deviation of an outlier's error, degrees or centimeters. By definition of the width
of its uniform density."""

NEW_MOVEMENT_RATE = 1e-3
"""Fraction of suspected movements that begin out of another kind of movement, such as a kick
out of standing still. Chosen by hand on 39 takes that are not scored: without it 304 samples of
clean takes are flagged, with it 203, and 3 % fewer of the burst samples are found."""

N_RARE_COMPONENTS = 8
"""Number of components, those of the largest movement, that rare movement exceeds. Chosen by
hand on 26 development takes at up to twice their speed: all 40 cost twice the time and separate
errors from movement no better."""
RARE_MOVEMENT_SCALE = 2.0
"""Ratio of rare movement to that of these components. Chosen by hand on the same takes: with 3
the error rises by 5 % where a tenth of the samples is wrong."""
RARE_MOVEMENT_WEIGHT = 0.03
"""Fraction of windows with rare movement. Chosen by hand on the same takes: x0.3 flags a tenth
more good samples of takes with bursts, x3 keeps a burst of two frames in a walk at 24 Hz."""


class PredictiveDensity:
    """The density of samples of a joint's channels, given the channels' other samples.

    With the cosines B of all samples of a window and their noise N, the precision matrix of a
    component of covariance C is N^-1 - W W', where W = N^-1 B L'^-1 and L is the lower
    triangular root of C^-1 + B' N^-1 B (matrix inversion lemma). It is the same for all windows
    of a joint. Samples that are not observed have an unknown error, which is integrated out:
    only a matrix of their number has to be factored for each window.

    Parameters
    ----------
    samples : shape (n_frames, 3)
        About the joint's mean, complete.
    noise : shape (3,)
    windows : Windows
    mixture : MotionMixture
    axes : shape (3, 3)
        Principal axes of the joint's movement, as columns.
    """

    def __init__(
        self,
        samples: Array,
        noise: Array,
        windows: Windows,
        mixture: MotionMixture,
        axes: Array,
    ) -> None:
        self._samples, self._noise, self._windows = samples, noise, windows
        self._mixture, self._basis = mixture, windows.dct_basis(mixture.window)
        self._axes, self._roots = axes, dict[tuple[int, ...], tuple[Array, Array]]()

    def of_run(
        self, run: slice, tested: NDArray[np.bool_], valid: NDArray[np.bool_]
    ) -> "RunDensity":
        """Return how likely the tested samples of a run are, given the valid other ones.

        Parameters
        ----------
        run : slice
            Frames; of a run longer than a window, those of one window count.
        tested : shape (3,)
            Channels. A single frame is compared with the other frames of these channels only,
            which takes a tenth of the time; a longer run with all channels.
        valid : shape (n_frames, 3)
            Where samples are observed and, outside the run, no outliers.
        """
        length = self._windows.length
        middle = (run.start + run.stop) // 2
        start = min(max(middle - length // 2, 0), len(self._samples) - length)
        inside = np.zeros((length, N_CHANNELS), dtype=np.bool_)
        inside[max(run.start - start, 0) : min(run.stop - start, length)] = tested
        is_single = run.stop - run.start == 1
        channels = tuple(np.flatnonzero(tested).tolist() if is_single else range(N_CHANNELS))
        frames = slice(start, start + length)
        return RunDensity(self, frames, channels, valid[frames], inside, not is_single)

    @property
    def log_weights(self) -> Array:
        """Logarithm of the weight of each component."""
        return np.log(self._mixture.weights)

    def log_marginals(
        self,
        frames: slice,
        channels: tuple[int, ...],
        observed: NDArray[np.bool_],
        offset: NDArray[np.bool_] | None = None,
        deviation: float = OFFSET_DEVIATION,
    ) -> tuple[Array, Array]:
        """Return each component's log-density of the observed samples of a window's channels.

        The second one is that with an unknown constant added to each channel in the frames of
        `offset`. The constants follow the missing samples, so that one factorization yields
        both. If their deviation is infinite, it is the density of the frames outside `offset`.
        """
        roots, log_densities = self._precision_roots(channels)
        columns, length = list(channels), len(self._basis)
        precision = np.repeat(self._noise[columns] ** -2.0, length)
        missing = np.flatnonzero(~observed[:, columns].T)
        shifts = np.zeros((0 if offset is None else len(columns), len(columns), length))
        if offset is not None:
            own = np.arange(len(columns))
            shifts[own, own] = (offset & observed)[:, columns].T
        # One row for each unknown; the samples come last.
        n_missing, n_unknown = len(missing), len(missing) + len(shifts)
        rows = np.zeros((n_unknown + 1, len(precision)))
        rows[np.arange(n_missing), missing] = 1.0
        rows[n_missing:n_unknown] = shifts.reshape(len(shifts), len(precision))
        rows[n_unknown] = self._samples[frames][:, columns].T.ravel()
        projected = np.concatenate([roots[missing], np.tensordot(rows[n_missing:], roots, 1)])
        projected = projected.transpose(1, 0, 2)
        factored = (rows * precision) @ rows.T - projected @ projected.transpose(0, 2, 1)
        own = np.arange(n_missing, n_unknown)
        factored[:, own, own] += deviation**-2
        square = factored[:, n_unknown, n_unknown].copy()
        factored[:, n_unknown, n_unknown] += 1.0  # not below 0 by rounding
        factors = np.linalg.cholesky(factored)
        exponents = 0.5 * factors[:, n_unknown, :n_unknown] ** 2
        exponents -= np.log(np.einsum("kss->ks", factors)[:, :n_unknown])
        exponents[:, :n_missing] += 0.5 * np.log(2.0 * np.pi)
        without = log_densities - 0.5 * square + exponents[:, :n_missing].sum(axis=1)
        # An infinite deviation is a density of 1 everywhere, without the factors of a Gaussian.
        scale = np.log(deviation) if np.isfinite(deviation) else -0.5 * np.log(2.0 * np.pi)
        of_offsets = exponents[:, n_missing:] - scale
        return without, without + of_offsets.sum(axis=1)

    def _precision_roots(self, channels: tuple[int, ...]) -> tuple[Array, Array]:
        """Return W, shape (n_samples, n_components, n_coefficients), and the log-density at 0.

        Of all samples of a window, channel by channel.
        """
        if channels not in self._roots:
            inverses, log_weights = self._invert_covariances(channels)
            precision = np.diag(self._noise[list(channels)] ** -2.0)
            factors = np.linalg.cholesky(
                inverses + np.kron(precision, self._basis.T @ self._basis)
            )
            roots = np.linalg.solve(factors, np.kron(precision, self._basis).T[None])
            log_scale = np.log(np.einsum("kss->ks", factors)).sum(axis=1)
            log_scale += 0.5 * len(self._basis) * np.log(2.0 * np.pi / np.diag(precision)).sum()
            self._roots[channels] = (
                np.ascontiguousarray(roots.transpose(2, 0, 1)), log_weights - log_scale,
            )  # fmt: skip
        return self._roots[channels]

    def _invert_covariances(self, channels: tuple[int, ...]) -> tuple[Array, Array]:
        """Return each component's inverse covariance, and the log of its weight and scale."""
        axes, weights = self._axes[list(channels)], self._mixture.weights
        if len(channels) == N_CHANNELS:
            inverses, log_scale = _invert_axes(self._mixture)
            return _in_channels(inverses, axes), np.log(weights) - log_scale
        covariances = _in_channels(self._mixture.covariances, axes)
        log_scale = 0.5 * np.linalg.slogdet(covariances)[1]
        return np.linalg.inv(covariances), np.log(weights) - log_scale


@dataclass(frozen=True, eq=False)
class RunDensity:
    """The density of the tested samples of a run, given the valid other ones.

    Attributes
    ----------
    predictive : PredictiveDensity
    frames : slice
        The window around the run.
    channels : tuple of int
        Those that are compared.
    valid, tested : shape (length, 3)
        Samples of the window.
    may_be_off : bool
        Whether each tested channel may be off by a constant during the run.
    """

    predictive: PredictiveDensity
    frames: slice
    channels: tuple[int, ...]
    valid: NDArray[np.bool_]
    tested: NDArray[np.bool_]
    may_be_off: bool

    @property
    def as_movement(self) -> float:
        """Log-density if the samples are right: the movement around them goes on, or another
        one begins."""
        return self._as_movement(self._both[0])

    def movement_of(self, right: NDArray[np.bool_]) -> float:
        """Return the same of some of the tested samples, without the others.

        Parameters
        ----------
        right : shape (length, 3)
        """
        valid = self.valid & (right | ~self.tested)
        both, _ = self.predictive.log_marginals(self.frames, self.channels, valid)
        return self._as_movement(both)

    @property
    def with_offset(self) -> float:
        """The same if each tested channel is off by a constant during the run."""
        return _log_sum(self._both[1]) - _log_sum(self._others) if self.may_be_off else -np.inf

    @property
    def max_gain(self) -> float:
        """The most by which `with_offset` can exceed `as_movement`, in half the time.

        It is the difference if the movement around the run can only go on.
        """
        both, with_offset = self._both
        return _log_sum(with_offset) - _log_sum(both) if self.may_be_off else -np.inf

    def _as_movement(self, both: Array) -> float:
        continued = _log_sum(both) - _log_sum(self._others)
        # The run may be of another kind of movement than the frames around it.
        begun = _log_sum(self.predictive.log_weights + both - self._others)
        return float(np.logaddexp(continued, np.log(NEW_MOVEMENT_RATE) + begun))

    @cached_property
    def _both(self) -> tuple[Array, Array]:
        """Of the tested and the other samples, for each component; and with an offset.

        A single frame that may be off by anything says nothing: its second density is that of
        the others.
        """
        deviation = OFFSET_DEVIATION if self.may_be_off else np.inf
        return self.predictive.log_marginals(
            self.frames, self.channels, self.valid, self.tested, deviation
        )

    @cached_property
    def _others(self) -> Array:
        if not self.may_be_off:
            return self._both[1]
        others = self.valid & ~self.tested
        return self.predictive.log_marginals(self.frames, self.channels, others)[0]


def _log_sum(log_densities: Array) -> float:
    """Return the logarithm of the sum of densities."""
    return float(np.logaddexp.reduce(log_densities))


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


@lru_cache(maxsize=4)
def with_rare_movement(mixture: MotionMixture) -> MotionMixture:
    """Return the mixture with heavier tails: people also move as its recordings do not.

    Copies of the components of the largest movement, scaled, join the mixture. A Gaussian
    alone takes a kick that is faster than any of the recordings for an error.
    """
    energies = np.einsum("kaii->k", mixture.covariances)
    largest = np.argsort(-energies, kind="stable")[:N_RARE_COMPONENTS]
    rare = mixture.covariances[largest] * RARE_MOVEMENT_SCALE**2
    weights = np.full(len(largest), RARE_MOVEMENT_WEIGHT / len(largest))
    return replace(
        mixture,
        weights=np.append((1.0 - RARE_MOVEMENT_WEIGHT) * mixture.weights, weights),
        covariances=np.concatenate([mixture.covariances, rare]),
    )
