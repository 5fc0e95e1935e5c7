"""Windows with a long gap in a channel: one exact solve per gap pattern."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ..window_priors import Windows

MAX_MATRIX_ENTRIES = 40_000_000
"""Entries of one matrix per gap pattern, over all patterns; two such matrices are stored and a
third is solved for, about 1 GB."""


@dataclass(frozen=True, eq=False)
class GapPattern:
    """Windows with the same gaps."""

    starts: NDArray[np.intp]
    channels: NDArray[np.intp]
    """Channels with gaps; empty for complete windows."""
    observed_mask: NDArray[np.bool_]
    """True where these channels are observed, shape (length, n_gap_channels)."""
    indices: NDArray[np.intp]
    """Of the slow coefficients of these channels among all, coefficients outermost."""
    missing_projection: Array
    """Projection of each of these channels on its missing frames, shape
    (n_gap_channels, n_slow, n_slow)."""

    def mask_frames(self, frames: Array) -> Array:
        """Return windows with zeros in the gaps."""
        frames = frames.copy()
        frames[:, :, self.channels] *= self.observed_mask
        return frames

    def project_rows(self, rows: Array) -> Array:
        """Return rows of coefficients at these indices, projected on the missing frames."""
        by_channel = rows.reshape(len(rows), -1, len(self.channels)).transpose(2, 0, 1)
        projected = by_channel @ self.missing_projection
        return np.asarray(projected.transpose(1, 2, 0).reshape(rows.shape))


@dataclass(frozen=True, eq=False)
class GapSolution:
    """The filter of windows with the same gaps.

    Let G be the filter of a window without gaps. Let N be the projection on the missing frames,
    in DCT coefficients; it is zero except within each channel with gaps. The posterior mean a
    solves a = G (b + N a), with b the coefficients of the observed samples. By Woodbury's
    identity only the channels with gaps have to be solved for: a small system. With G and N at
    their indices, X = (1 - G N)^-1 G gives N (1 - G N)^-1 = N + N X N.
    """

    gain: Array
    """G, shape (size, size)."""
    lift: Array
    """N + N X N at the indices of the gaps, a square matrix."""
    added_covariance: Array
    """X - G: posterior covariance that the gaps add there, in units of the noise."""

    @classmethod
    def solve(cls, pattern: GapPattern, gain: Array) -> "GapSolution":
        """Solve once for all windows of a pattern."""
        inner = gain[np.ix_(pattern.indices, pattern.indices)]
        identity = np.eye(len(inner))
        solved = np.linalg.solve(identity - pattern.project_rows(inner), inner)
        lift = pattern.project_rows(pattern.project_rows(solved).T + identity)
        return cls(gain, lift, solved - inner)

    def posterior_mean(self, coefficients: Array, indices: NDArray[np.intp]) -> Array:
        """Return posterior coefficients from the observed ones, shape (n_windows, size)."""
        mean = coefficients @ self.gain
        return np.asarray(mean + (mean[:, indices] @ self.lift.T) @ self.gain[indices])


def find_gap_patterns(
    observed: NDArray[np.bool_], windows: Windows, n_slow: int
) -> list[GapPattern]:
    """Group the windows by their long gaps; of those with gaps, use every second window.

    Short gaps of a channel with a long one in the window belong to it. Filled iteratively, from
    an estimate with little support, they would drift without end.

    If the matrices of all patterns would fill the memory, all gaps are filled iteratively, like
    short ones.
    """
    gaps = find_long_gaps(observed, windows.long_gap)
    groups: dict[bytes, list[int]] = {}
    for index, start in enumerate(windows.starts):
        missing = _missing_samples(observed, gaps, start, windows.length)
        if index % 2 and start != windows.starts[-1] and missing.any():
            continue
        groups.setdefault(np.packbits(missing).tobytes(), []).append(int(start))
    sizes = [
        n_slow
        * int(_missing_samples(observed, gaps, starts[0], windows.length).any(axis=0).sum())
        for starts in groups.values()
    ]
    if sum(size**2 for size in sizes) > MAX_MATRIX_ENTRIES:
        return find_gap_patterns(observed, replace(windows, solve_gaps=False), n_slow)
    basis = windows.dct_basis(n_slow) / np.sqrt(windows.density)
    patterns = []
    for starts in groups.values():
        missing = _missing_samples(observed, gaps, starts[0], windows.length)
        channels = np.flatnonzero(missing.any(axis=0))
        mask = missing[:, channels].astype(float)
        missing_projection = np.einsum("tk,tc,tj->ckj", basis, mask, basis)
        indices = np.arange(n_slow)[:, None] * observed.shape[1] + channels
        patterns.append(
            GapPattern(
                np.array(starts),
                channels,
                mask == 0.0,
                indices.ravel(),
                missing_projection,
            )
        )
    return patterns


def _missing_samples(
    observed: NDArray[np.bool_], gaps: NDArray[np.bool_], start: int, length: int
) -> NDArray[np.bool_]:
    """Return the missing samples of a window's channels with long gaps, (length,
    n_channels)."""
    window = slice(start, start + length)
    return np.asarray(~observed[window] & gaps[window].any(axis=0))


def find_long_gaps(observed: NDArray[np.bool_], min_frames: int) -> NDArray[np.bool_]:
    """Return where a channel is unobserved for at least this many consecutive frames."""
    n_frames = len(observed)
    frames = np.arange(n_frames)[:, None]
    before = np.maximum.accumulate(np.where(observed, frames, -1), axis=0)
    after = np.minimum.accumulate(np.where(observed, frames, n_frames)[::-1], axis=0)[::-1]
    return np.asarray(~observed & (after - before > min_frames))
