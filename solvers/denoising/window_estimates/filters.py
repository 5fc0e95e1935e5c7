"""Filters for the windows of a take, complete or with gaps."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from ...arrays import Array
from ..window_priors import Windows
from .covariance import WindowCovariance
from .gap_patterns import GapPattern, GapSolution

MAX_BLOCK_ROWS = 64
"""Rows of a symmetric matrix that are copied at a time. It bounds the run time."""


@dataclass(frozen=True, eq=False)
class Gains:
    """Gains of one iteration, in units of the noise."""

    slow: Array
    """Posterior from measured slow coefficients in units of the noise, a square matrix."""
    fast: Array
    """Factor of each fast coefficient, shape (length - n_slow, n_channels)."""
    noise: Array
    """Standard deviation of a coefficient, shape (n_channels,)."""
    own: Array | None = None
    """The blocks of `slow` of each channel, shape (n_channels, n_slow, n_slow), if all others
    are zero."""

    def posterior_mean(self, coefficients: Array) -> Array:
        """Return posterior slow coefficients from measured ones, shape (n_windows, size)."""
        if self.own is None:
            return coefficients @ self.slow
        by_channel = coefficients.reshape(len(coefficients), -1, len(self.own))
        mean = by_channel.transpose(2, 0, 1) @ self.own
        return mean.transpose(1, 2, 0).reshape(coefficients.shape)


@dataclass(frozen=True, eq=False)
class Filter:
    """The filter of all windows with the same gaps."""

    pattern: GapPattern
    gains: Gains
    gaps: GapSolution | None
    """None for complete windows."""


def sum_covariances(filters: list[Filter]) -> Array:
    """Return the sum of the posterior covariances, (n, n), of all windows.

    n is the number of slow coefficients of a window, times that of channels.
    """
    total = np.zeros_like(filters[0].gains.slow)
    for gains in {id(each.gains): each.gains for each in filters}.values():
        with_gains = [each for each in filters if each.gains is gains]
        covariance = gains.slow * sum(len(each.pattern.starts) for each in with_gains)
        for indices, added in _sum_at_gaps(with_gains):
            covariance[np.ix_(indices, indices)] += added
        scale = np.tile(gains.noise, len(total) // len(gains.noise))
        covariance *= scale
        covariance *= scale[:, None]
        total += covariance
    return total


def _sum_at_gaps(filters: list[Filter]) -> Iterator[tuple[NDArray[np.intp], Array]]:
    """Yield the covariance that gaps add, summed over windows with the same gap channels."""
    groups: dict[bytes, list[Filter]] = {}
    for each in filters:
        groups.setdefault(each.pattern.channels.tobytes(), []).append(each)
    for group in groups.values():
        solutions = [(len(each.pattern.starts), each.gaps) for each in group if each.gaps]
        if solutions:
            added = sum(n_windows * gaps.added_covariance() for n_windows, gaps in solutions)
            yield group[0].pattern.indices, np.asarray(added)


def build_filters(
    patterns: list[GapPattern],
    covariance: WindowCovariance,
    noise: Array,
    decoupling: float,
    windows: Windows,
    *,
    reusable: Sequence[Filter] = (),
) -> list[Filter]:
    """Return the filter of each gap pattern; the noise is of each channel, (n_channels,).

    Filters of windows with gaps are expensive. They are taken from `reusable`, filters of the
    same patterns that are nearly correct, if given.
    """
    filters, gains = [], dict[bool, Gains]()
    for index, pattern in enumerate(patterns):
        has_gaps = bool(pattern.channels.size)
        if has_gaps and reusable:
            filters.append(reusable[index])
            continue
        if has_gaps not in gains:
            gains[has_gaps] = (
                _gapped_gains(covariance, noise, decoupling, patterns, windows)
                if has_gaps
                else compute_gains(covariance.slow, covariance.fast, noise, windows.density)
            )
        window_gains = gains[has_gaps]
        solution = GapSolution.solve(pattern, window_gains.slow) if has_gaps else None
        filters.append(Filter(pattern, window_gains, solution))
    return filters


def compute_variance(
    filters: list[Filter], windows: Windows, samples: Array
) -> tuple[Array, Array]:
    """Return the posterior variance and the leverage of every sample.

    Both have shape (n_frames, n_channels). The leverage is relative to the noise of each
    filter; it has no meaning where nothing is observed.
    """
    total, leverage = np.zeros_like(samples), np.zeros_like(samples)
    weight = sum_window_weights([window_filter.pattern for window_filter in filters], windows)
    window_gains: dict[int, Array] = {}
    for window_filter in filters:
        key = id(window_filter.gains)
        if key not in window_gains:
            window_gains[key] = _window_variance(
                window_filter.gains.slow, window_filter.gains.noise, windows
            )
            window_gains[key] += _fast_variance(window_filter.gains, windows)
        variance = window_gains[key].copy()
        if window_filter.gaps:
            gaps, noise = (
                window_filter.pattern.channels,
                window_filter.gains.noise[window_filter.pattern.channels],
            )
            basis = windows.dct_basis(window_filter.gaps.factor.shape[1])
            variance[:, gaps] += window_filter.gaps.added_variance(basis) * noise**2
        windows.add(total, variance, window_filter.pattern.starts)
        per_sample = window_filter.gains.noise**2 * windows.density
        windows.add(leverage, variance / per_sample, window_filter.pattern.starts)
    return np.maximum(total / weight, 0.0), np.maximum(leverage / weight, 0.0)


def sum_window_weights(patterns: list[GapPattern], windows: Windows) -> Array:
    """Return the sum of all window weights per frame, shape (n_frames, 1)."""
    weight = np.zeros((windows.n_frames, 1))
    for pattern in patterns:
        windows.add(weight, np.ones((windows.length, 1)), pattern.starts)
    return weight


def _gapped_gains(
    covariance: WindowCovariance,
    noise: Array,
    decoupling: float,
    patterns: list[GapPattern],
    windows: Windows,
) -> Gains:
    """Return the filter of windows with gaps.

    Through a gap, fast coefficients look like noise. The covariance with other channels is
    reduced, because another body may hold its limbs differently.
    """
    slow, fast = covariance.slow_in_gaps, covariance.fast
    n_slow, n_channels = len(slow) // len(noise), len(noise)
    decoupled = ((1.0 - decoupling) * slow).reshape(n_slow, n_channels, n_slow, n_channels)
    channels = np.arange(n_channels)
    blocks = slow.reshape(decoupled.shape)[:, channels, :, channels]
    decoupled[:, channels, :, channels] += decoupling * blocks
    gaps = np.unique(np.concatenate([pattern.channels for pattern in patterns]))
    blurred = noise**2
    blurred[gaps] += fast[:, gaps].sum(axis=0) * windows.density / windows.length
    return compute_gains(decoupled.reshape(slow.shape), fast, np.sqrt(blurred), windows.density)


def compute_gains(slow: Array, fast: Array, noise: Array, density: float) -> Gains:
    """Return the filter of complete windows for a prior and a noise.

    Parameters
    ----------
    slow : square matrix
        Covariance of the slow coefficients, coefficients outermost.
    fast : shape (n_fast, n_channels)
        Variances of the fast coefficients.
    noise : shape (n_channels,)
        Standard deviation of a sample.
    density : float
        Frames of the take per frame of the patterns.
    """
    noise_per_coefficient = noise / np.sqrt(density)
    fast_gains = fast / (fast + noise_per_coefficient**2)
    n_slow, channels = len(slow) // len(noise), np.arange(len(noise))
    blocks = slow.reshape(n_slow, len(noise), n_slow, len(noise))
    own = blocks[:, channels, :, channels]
    if np.count_nonzero(own) == np.count_nonzero(slow):
        whitened = own / noise_per_coefficient[:, None, None] ** 2 + np.eye(n_slow)
        own = np.eye(n_slow) - np.linalg.inv(whitened)
        gain = np.zeros_like(blocks)
        gain[:, channels, :, channels] = own
        return Gains(gain.reshape(slow.shape), fast_gains, noise_per_coefficient, own)
    scale = np.tile(noise_per_coefficient, n_slow)
    size = len(scale)
    whitened = np.ascontiguousarray(slow) / scale
    whitened /= scale[:, None]
    whitened[np.diag_indices(size)] += 1.0
    # LAPACK's inverse takes a third of the time of solving for the identity. It is in place,
    # and only one triangle is complete.
    scipy.linalg.lapack.dpotrf(whitened.T, lower=1, clean=0, overwrite_a=1)
    scipy.linalg.lapack.dpotri(whitened.T, lower=1, overwrite_c=1)
    gain = np.negative(whitened, out=whitened)
    for first in range(0, size, MAX_BLOCK_ROWS):
        rows = slice(first, first + MAX_BLOCK_ROWS)
        gain[rows, :first] = gain[:first, rows].T
        gain[rows, rows] = np.triu(gain[rows, rows]) + np.triu(gain[rows, rows], 1).T
    gain[np.diag_indices(size)] += 1.0
    return Gains(gain, fast_gains, noise_per_coefficient)


def _window_variance(covariance: Array, noise: Array, windows: Windows) -> Array:
    """Return the variance of each frame of a window, shape (length, n_channels).

    The covariance of the slow coefficients is in units of the noise.
    """
    n_channels = len(noise)
    n_slow = len(covariance) // n_channels
    basis = windows.dct_basis(n_slow)
    blocks = covariance.reshape(n_slow, n_channels, n_slow, n_channels)
    own = np.einsum("kcjc->ckj", blocks)
    return np.asarray(np.einsum("tk,ckj,tj->tc", basis, own, basis) * noise**2)


def _fast_variance(gains: Gains, windows: Windows) -> Array:
    """Return the variance of each frame from the fast coefficients, as if without gaps."""
    n_fast = len(gains.fast)
    basis = windows.dct_basis(windows.length)[:, windows.length - n_fast :]
    return np.asarray(basis**2 @ gains.fast * gains.noise**2)
