"""Windows with a long gap in a channel: one exact solve per gap pattern."""

from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from ...arrays import Array
from ..window_priors import Windows

MAX_MATRIX_ENTRIES = 40_000_000
"""Entries of `GapSolution.whitened`, over all gap patterns. It bounds the memory: with the
triangles, which are no larger, 640 MB."""


@dataclass(frozen=True, eq=False)
class GapPattern:
    """Windows with the same gaps."""

    starts: NDArray[np.intp]
    channels: NDArray[np.intp]
    """Channels with gaps; empty for complete windows."""
    observed_mask: NDArray[np.bool_]
    """True where these channels are observed, shape (length, n_gap_channels)."""
    indices: NDArray[np.intp]
    """Of the slow coefficients of these channels among all, channels outermost."""
    missing_factor: Array
    """Square root B of the projection of each of these channels on its missing frames, shape
    (n_gap_channels, n_slow, rank): the projection is B B^T."""

    def mask_frames(self, frames: Array) -> Array:
        """Return windows (n_windows, length, n_channels) with zeros in the gaps."""
        frames = frames.copy()
        frames[:, :, self.channels] *= self.observed_mask
        return frames


@dataclass(frozen=True, eq=False)
class GapSolution:
    """The filter of windows with the same gaps.

    Let G be the filter of a window without gaps. Let N = B B^T be the projection on the missing
    frames, in DCT coefficients; it is zero except within each channel with gaps. The posterior
    mean a solves a = G (b + N a), with b the coefficients of the observed samples. By
    Woodbury's identity a = G b + G B S B^T G b with S = (1 - B^T G B)^-1: a system of the size
    of the missing samples, or of the slow coefficients of the channels with gaps where these
    are fewer. The gaps add the covariance G B S B^T G.
    """

    gain: Array
    """G, shape (size, size)."""
    factor: Array
    """B by channel, shape (n_gap_channels, n_slow, rank)."""
    cholesky: Array
    """L with L L^T = 1 - B^T G B, a lower triangle."""
    whitened: Array
    """L^-1 B^T G at the indices of the gaps, shape (n_gap_channels * rank, n_gap_channels *
    n_slow)."""

    @classmethod
    def solve(cls, pattern: GapPattern, gain: Array) -> "GapSolution":
        """Solve once for all windows of a pattern."""
        factor = pattern.missing_factor
        n_channels, n_slow, rank = factor.shape
        inner = gain[np.ix_(pattern.indices, pattern.indices)]
        by_channel = inner.reshape(n_channels, n_slow, -1)
        rows = (factor.transpose(0, 2, 1) @ by_channel).reshape(n_channels * rank, -1)
        system = np.eye(len(rows)) - _times_factor(rows, factor)
        cholesky = scipy.linalg.cholesky(system, lower=True, overwrite_a=True)
        whitened = scipy.linalg.solve_triangular(cholesky, rows, lower=True, overwrite_b=True)
        return cls(gain, factor, cholesky, whitened)

    def posterior_mean(self, coefficients: Array, indices: NDArray[np.intp]) -> Array:
        """Return posterior coefficients from the observed ones, shape (n_windows, size)."""
        mean = coefficients @ self.gain
        missing = _times_factor(mean[:, indices], self.factor)
        solved = scipy.linalg.cho_solve((self.cholesky, True), missing.T).T
        filled = _times_factor(solved, self.factor.transpose(0, 2, 1))
        return np.asarray(mean + filled @ self.gain[indices])

    def added_covariance(self) -> Array:
        """Return the posterior covariance that the gaps add, in units of the noise.

        It is a square matrix at the indices of the gaps.
        """
        return np.asarray(self.whitened.T @ self.whitened)

    def added_variance(self, basis: Array) -> Array:
        """Return the variance that the gaps add to each frame, shape (length, n_gap_channels).

        It is in units of the noise; the basis maps the slow coefficients to frames.
        """
        n_channels, n_slow, _ = self.factor.shape
        by_channel = self.whitened.reshape(-1, n_channels, n_slow).transpose(1, 0, 2)
        blocks = by_channel.transpose(0, 2, 1) @ by_channel
        return np.asarray(np.einsum("tk,ckj,tj->tc", basis, blocks, basis))


def _times_factor(rows: Array, factor: Array) -> Array:
    """Return rows times a matrix that has one block, `factor[c]`, for each channel c."""
    by_channel = rows.reshape(len(rows), len(factor), -1).transpose(1, 0, 2)
    return np.asarray((by_channel @ factor).transpose(1, 0, 2).reshape(len(rows), -1))


def find_gap_patterns(
    observed: NDArray[np.bool_], windows: Windows, n_slow: int
) -> list[GapPattern]:
    """Group the windows by their long gaps; of those with gaps, use every second window.

    Short gaps of a channel with a long one in the window belong to it. Filled iteratively, from
    an estimate with little support, they would drift without end.

    If the matrices of all patterns would fill the memory, all gaps are filled iteratively, like
    short ones. `observed` has the shape (n_frames, n_channels).
    """
    gaps = find_long_gaps(observed, windows.long_gap)
    groups: dict[bytes, list[int]] = {}
    for index, start in enumerate(windows.starts):
        missing = _missing_samples(observed, gaps, start, windows.length)
        if index % 2 and start != windows.starts[-1] and missing.any():
            continue
        groups.setdefault(np.packbits(missing).tobytes(), []).append(int(start))
    n_entries = 0
    for starts in groups.values():
        n_missing = _missing_samples(observed, gaps, starts[0], windows.length).sum(axis=0)
        rank = min(int(n_missing.max(initial=0)), n_slow)
        n_entries += rank * n_slow * int(np.count_nonzero(n_missing)) ** 2
    if n_entries > MAX_MATRIX_ENTRIES:
        return find_gap_patterns(observed, replace(windows, solve_gaps=False), n_slow)
    basis = windows.dct_basis(n_slow) / np.sqrt(windows.density)
    patterns = []
    for starts in groups.values():
        missing = _missing_samples(observed, gaps, starts[0], windows.length)
        channels = np.flatnonzero(missing.any(axis=0))
        mask = missing[:, channels].astype(float)
        indices = np.arange(n_slow) * observed.shape[1] + channels[:, None]
        patterns.append(
            GapPattern(
                np.array(starts),
                channels,
                mask == 0.0,
                indices.ravel(),
                _missing_factor(basis, mask),
            )
        )
    return patterns


def _missing_factor(basis: Array, mask: Array) -> Array:
    """Return the factor of the projection on the missing frames of each channel.

    The mask is 1.0 where a sample is missing, shape (length, n_gap_channels).
    """
    masks, kind = np.unique(mask, axis=1, return_inverse=True)
    projections = np.einsum("tk,tc,tj->ckj", basis, masks, basis)
    values, vectors = np.linalg.eigh(projections)
    n_slow = basis.shape[1]
    rank = min(int(masks.sum(axis=0).max(initial=0.0)), n_slow)
    factors = vectors * np.sqrt(np.maximum(values, 0.0))[:, None]
    return np.ascontiguousarray(factors[kind.ravel(), :, n_slow - rank :])


def _missing_samples(
    observed: NDArray[np.bool_], gaps: NDArray[np.bool_], start: int, length: int
) -> NDArray[np.bool_]:
    """Return the missing samples of a window's channels with long gaps, (length,
    n_channels)."""
    window = slice(start, start + length)
    return np.asarray(~observed[window] & gaps[window].any(axis=0))


def find_long_gaps(observed: NDArray[np.bool_], min_frames: int) -> NDArray[np.bool_]:
    """Return where channels, (n_frames, n), are missing for this many frames or more."""
    n_frames = len(observed)
    frames = np.arange(n_frames)[:, None]
    before = np.maximum.accumulate(np.where(observed, frames, -1), axis=0)
    after = np.minimum.accumulate(np.where(observed, frames, n_frames)[::-1], axis=0)[::-1]
    return np.asarray(~observed & (after - before > min_frames))
