"""Likelihood of samples of a joint, given the other samples of their window."""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ..motion_model import N_CHANNELS, MotionMixture
from ..window_priors import Windows
from .single_outliers import OUTLIER_DENSITY

OFFSET_DEVIATION = 0.5 / OUTLIER_DENSITY / np.sqrt(3.0)
"""Standard deviation of an outlier's error, degrees or centimeters. By the width of its uniform
density."""

NEW_MOVEMENT_RATE = 1e-3
"""Fraction of suspected movements that begin out of another kind of movement, such as a kick
out of standing still. Chosen by hand on 39 takes that are not scored: without it 304 samples of
clean takes are flagged, with it 203, and 3 % fewer of the burst samples are found."""


class PredictiveDensity:
    """The density of samples of a joint's channels, given the channels' other samples.

    With B the cosines at the observed samples of a window and s^2 the noise, the log-density of
    a component of covariance C follows by the matrix inversion lemma: only C^-1 + B' B / s^2
    has to be factored.

    Parameters
    ----------
    samples : shape (n_frames, 3)
        About the joint's mean, complete.
    noise : shape (3,)
    windows : Windows
    mixture : MotionMixture
    """

    def __init__(
        self, samples: Array, noise: Array, windows: Windows, mixture: MotionMixture
    ) -> None:
        self._samples, self._noise, self._windows = samples, noise, windows
        self._mixture, self._basis = mixture, windows.dct_basis(mixture.window)

    def log_densities(
        self, run: slice, tested: NDArray[np.bool_], valid: NDArray[np.bool_]
    ) -> tuple[float, float]:
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

        Returns
        -------
        as_movement : float
            Log-density if the samples are right: the movement around them goes on, or another
            one begins.
        with_offset : float
            The same if each tested channel is off by a constant during the run.
        """
        length = self._windows.length
        middle = (run.start + run.stop) // 2
        start = int(np.clip(middle - length // 2, 0, len(self._samples) - length))
        frames = slice(start, start + length)
        everything = valid[frames]
        inside = np.zeros((length, N_CHANNELS), dtype=np.bool_)
        inside[max(run.start - start, 0) : min(run.stop - start, length)] = tested
        is_single = run.stop - run.start == 1
        channels = tuple(np.flatnonzero(tested)) if is_single else tuple(range(N_CHANNELS))
        others = self._log_marginals(frames, channels, everything & ~inside)
        both = self._log_marginals(frames, channels, everything)
        log_others = _log_sum(others)
        continued = _log_sum(both) - log_others
        # The run may be of another kind of movement than the frames around it.
        log_weights = np.log(self._mixture.weights)
        begun = np.log(NEW_MOVEMENT_RATE) + _log_sum(log_weights + both - others)
        as_movement = float(np.logaddexp(continued, begun))
        if is_single:
            return as_movement, -np.inf
        with_offset = self._log_marginals(frames, channels, everything, inside)
        return as_movement, _log_sum(with_offset) - log_others

    def _log_marginals(
        self,
        frames: slice,
        channels: tuple[int, ...],
        observed: NDArray[np.bool_],
        offset: NDArray[np.bool_] | None = None,
    ) -> Array:
        """Return each component's log-density of the observed samples of a window's channels.

        With `offset`, each channel is off by an unknown constant in these frames.
        """
        n, log_scale = self._basis.shape[1], 0.0
        inverses, log_weights = _inverse_covariances(self._mixture, channels)
        size = n * len(channels)
        total = size + (0 if offset is None else len(channels))
        # Besides the precision matrix: the projected values, and more than their square can be.
        added = np.zeros((total + 1, total + 1))
        added[total, total] = 1.0
        for index, channel in enumerate(channels):
            rows, variance = observed[:, channel], self._noise[channel] ** 2
            basis, values = self._basis[rows], self._samples[frames, channel][rows]
            block = slice(index * n, (index + 1) * n)
            added[block, block] = basis.T @ basis / variance
            added[total, block] = basis.T @ values / variance
            if offset is not None:
                own, is_off = size + index, offset[rows, channel]
                added[own, block] = is_off @ basis / variance
                added[own, own] = OFFSET_DEVIATION**-2 + is_off.sum() / variance
                added[total, own] = is_off @ values / variance
                log_scale += np.log(OFFSET_DEVIATION**2)
            added[total, total] += values @ values / variance
            log_scale += len(values) * np.log(2.0 * np.pi * variance)
        factored = np.repeat(added[None], len(inverses), axis=0)
        factored[:, :size, :size] += inverses
        factors = np.linalg.cholesky(factored)  # of the lower triangles
        whitened, diagonals = factors[:, total, :total], np.einsum("kss->ks", factors)
        exponents = 0.5 * np.einsum("ks,ks->k", whitened, whitened)
        exponents -= np.log(diagonals[:, :total]).sum(axis=1)
        constant = log_scale + added[total, total] - 1.0
        return np.asarray(log_weights + exponents - 0.5 * constant)


def _log_sum(log_densities: Array) -> float:
    """Return the logarithm of the sum of densities."""
    return float(np.logaddexp.reduce(log_densities))


@lru_cache(maxsize=16)
def _inverse_covariances(
    mixture: MotionMixture, channels: tuple[int, ...]
) -> tuple[Array, Array]:
    """Return each component's inverse covariance, and the logarithm of its weight and scale."""
    n = mixture.window
    indices = np.concatenate([
        np.arange(channel * n, (channel + 1) * n) for channel in channels
    ])
    covariances = mixture.covariances[:, indices[:, None], indices]
    scale = 0.5 * np.linalg.slogdet(covariances)[1]
    return np.linalg.inv(covariances), np.log(mixture.weights) - scale
