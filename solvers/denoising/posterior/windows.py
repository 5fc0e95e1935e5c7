"""A take cut into overlapping windows, each told by slow and fast waves of every channel."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray
from scipy.fft import dct, idct

Array = NDArray[np.float64]

N_OVERLAPS = 6
"""Windows that start in the length of one."""
N_FEW_OVERLAPS = 4
"""The same where an estimate is not the last, and in long takes."""
LONG_TAKE_FRAMES = 20_000
"""Frames from which on windows overlap less."""

LONG_GAP_FRACTION = 0.2
"""Share of a window from which on a gap is solved for exactly. Shorter ones fill quickly."""


@dataclass(frozen=True)
class Windows:
    """The cutting of `n_frames` frames into windows of `length` frames, and its undoing.

    A window is the sum of cosine waves (the orthonormal discrete cosine transform, divided by
    the root of `density`, so that the same movement has the same waves at any frame rate).
    """

    n_frames: int
    length: int
    density: float
    """Frames of the take per frame of the patterns that it is compared with."""
    n_overlaps: int = N_OVERLAPS
    """Windows that start in the length of one, as far as frames allow."""
    solve_gaps: bool = True
    """Solve for long gaps exactly; otherwise fill them round by round, like short ones."""

    @property
    def with_less_overlap(self) -> "Windows":
        """The same with windows that overlap less."""
        return replace(self, n_overlaps=N_FEW_OVERLAPS)

    @property
    def long_gap(self) -> int:
        """Frames from which on a gap is solved for exactly."""
        if not self.solve_gaps:
            return self.n_frames
        return max(round(LONG_GAP_FRACTION * self.length), 2)

    @cached_property
    def starts(self) -> NDArray[np.intp]:
        """First frame of every window; the last window ends with the take."""
        last = self.n_frames - self.length
        n_overlaps = self.n_overlaps if self.n_frames < LONG_TAKE_FRAMES else N_FEW_OVERLAPS
        hop = max(self.length // n_overlaps, 1)
        return np.asarray(np.unique(np.append(np.arange(0, last, hop), last)), dtype=np.intp)

    @cached_property
    def _taper(self) -> Array:
        """A window knows least at its ends, and counts least there."""
        phases = (np.arange(self.length) + 0.5) / self.length
        return np.asarray(0.1 + np.sin(np.pi * phases[:, None]))

    def extract(self, values: Array, starts: NDArray[np.intp]) -> Array:
        """Return the frames of these windows, shape (n_windows, length, n_channels)."""
        extract = sliding_window_view(values, self.length, axis=0)[starts]
        return np.asarray(extract.transpose(0, 2, 1))

    def coefficients_from_frames(self, frames: Array) -> Array:
        """Return the waves of windows, both of shape (n_windows, length, n_channels)."""
        return np.asarray(dct(frames, axis=1, norm="ortho") / np.sqrt(self.density))

    def frames_from_coefficients(self, coefficients: Array) -> Array:
        """Undo `waves_of`."""
        return np.asarray(idct(coefficients, axis=1, norm="ortho") * np.sqrt(self.density))

    def add(self, total: Array, frames: Array, starts: NDArray[np.intp]) -> None:
        """Add windows of frames, or the same one at all starts, to the sum of all."""
        frames = np.broadcast_to(frames * self._taper, (len(starts), *frames.shape[-2:]))
        for start, window in zip(starts, frames, strict=True):
            total[start : start + self.length] += window

    def dct_basis(self, n_coefficients: int) -> Array:
        """Return the slowest waves, shape (length, n_waves): frames = shapes @ waves."""
        identity = np.eye(self.length)[:, :n_coefficients]
        return np.asarray(idct(identity, axis=0, norm="ortho") * np.sqrt(self.density))
