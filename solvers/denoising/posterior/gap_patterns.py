"""Windows in which a channel is missing for long: one exact solve per pattern of gaps."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .windows import Windows

Array = NDArray[np.float64]

MAX_MATRIX_ENTRIES = 40_000_000
"""In one matrix of each pattern of gaps, all together; three such are kept, some 1 GB."""


@dataclass(frozen=True, eq=False)
class GapPattern:
    """Windows that have the same gaps."""

    starts: NDArray[np.intp]
    channels: NDArray[np.intp]
    """Channels with gaps; none for windows that are complete."""
    observed_mask: NDArray[np.bool_]
    """Where these channels are observed, shape (length, n_gap_channels)."""
    indices: NDArray[np.intp]
    """Of the slow waves of these channels among all, waves outermost."""
    missing_projection: Array
    """The part of the identity that is unobserved, at these places: a square matrix."""

    def mask_frames(self, frames: Array) -> Array:
        """Return windows with zero for whatever stands in the gaps."""
        frames = frames.copy()
        frames[:, :, self.channels] *= self.observed_mask
        return frames


@dataclass(frozen=True, eq=False)
class GapSolution:
    """The filter of windows with the same gaps.

    With the filter G for a window without gaps, and N the part of the identity that is
    unobserved (in waves, zero but for the channels with gaps), the posterior mean a solves
    a = G (b + N a), where b are the waves of what is observed. Only the channels with gaps
    have to be solved for: a small system, by Woodbury's identity.
    """

    gain: Array
    """G, shape (size, size)."""
    lift: Array
    """N (1 - G N)^-1 at the places of the gaps, a square matrix."""
    added_covariance: Array
    """What the gaps add to the posterior covariance there, in units of the noise."""

    @classmethod
    def solve(cls, pattern: GapPattern, gain: Array) -> "GapSolution":
        """Solve once for all windows of a pattern."""
        inner = gain[np.ix_(pattern.indices, pattern.indices)]
        system = np.eye(len(inner)) - inner @ pattern.missing_projection
        solved = np.linalg.solve(system, np.hstack([np.eye(len(inner)), inner]))
        lift = pattern.missing_projection @ solved[:, : len(inner)]
        return cls(gain, lift, solved[:, len(inner) :] - inner)

    def posterior_mean(self, coefficients: Array, indices: NDArray[np.intp]) -> Array:
        """Return posterior waves from those of what is observed, shape (n_windows, size)."""
        mean = coefficients @ self.gain
        return np.asarray(mean + (mean[:, indices] @ self.lift.T) @ self.gain[indices])


def find_gap_patterns(
    observed: NDArray[np.bool_], windows: Windows, n_slow: int
) -> list[GapPattern]:
    """Sort the windows by the long gaps in them; of those with gaps, every second will do.

    The short gaps of a channel that has a long one in the window belong to it: filled round by
    round, from an estimate that leans on little, they would drift away without end.

    Gaps of so many patterns that their matrices would fill the memory are filled round by
    round, like short ones.
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
        blocks = np.einsum("tk,tc,tj->ckj", basis, mask, basis)
        missing_projection = np.zeros((n_slow, len(channels), n_slow, len(channels)))
        for channel in range(len(channels)):
            missing_projection[:, channel, :, channel] = blocks[channel]
        indices = np.arange(n_slow)[:, None] * observed.shape[1] + channels
        size = n_slow * len(channels)
        patterns.append(
            GapPattern(
                np.array(starts),
                channels,
                mask == 0.0,
                indices.ravel(),
                missing_projection.reshape(size, size),
            )
        )
    return patterns


def _missing_samples(
    observed: NDArray[np.bool_], gaps: NDArray[np.bool_], start: int, length: int
) -> NDArray[np.bool_]:
    """Return what is missing in a window of channels with long gaps, (length, n_channels)."""
    window = slice(start, start + length)
    return np.asarray(~observed[window] & gaps[window].any(axis=0))


def find_long_gaps(observed: NDArray[np.bool_], min_frames: int) -> NDArray[np.bool_]:
    """Return where a channel is unobserved for at least so many frames on end."""
    n_frames = len(observed)
    frames = np.arange(n_frames)[:, None]
    before = np.maximum.accumulate(np.where(observed, frames, -1), axis=0)
    after = np.minimum.accumulate(np.where(observed, frames, n_frames)[::-1], axis=0)[::-1]
    return np.asarray(~observed & (after - before > min_frames))
