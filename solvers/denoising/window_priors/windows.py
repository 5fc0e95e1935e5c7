"""Split a take into overlapping windows represented by DCT coefficients."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from ...arrays import Array
from .noise_spectrum import WHITE, NoiseSpectrum

N_OVERLAPS = 6
"""Number of windows, and of trial gaps of a limb, that start within the length of one. Half and
twice gain less than 1 % (`make sensitivity`)."""
N_FEW_OVERLAPS = 4
"""The same for preliminary estimates and for long takes. Half and twice are no better
(`make sensitivity`)."""
LONG_TAKE_FRAMES = 20_000
"""Frames above which windows overlap less. It bounds the run time of long takes."""

LONG_GAP_FRACTION = 0.2
"""Fraction of a window above which a gap is solved exactly. Shorter gaps converge quickly. Half
and twice are no better (`make sensitivity`)."""


@dataclass(frozen=True)
class Windows:
    """Split `n_frames` frames into windows of `length` frames, and add windows up again.

    A window is a sum of cosines (the orthonormal discrete cosine transform, divided by the root
    of `density`, so that the same movement has the same coefficients at any frame rate). If the
    noise is not white, coefficients are divided by `noise_deviations`, so that their noise is.
    Then the transform is not orthonormal, which long gaps need: the take must be complete.
    """

    n_frames: int
    length: int
    density: float
    """Frames of the take per frame of the patterns."""
    n_overlaps: int = N_OVERLAPS
    """Number of windows that start within the length of one, as far as frames allow."""
    solve_gaps: bool = True
    """Solve long gaps exactly; otherwise fill them iteratively, like short ones."""
    noise_spectrum: NoiseSpectrum = WHITE

    @property
    def with_less_overlap(self) -> "Windows":
        """The same take with windows that overlap less."""
        return replace(self, n_overlaps=N_FEW_OVERLAPS)

    @property
    def long_gap(self) -> int:
        """Frames above which a gap is solved exactly."""
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
        """Weight of each frame of a window: least at its ends, where it has the least
        support."""
        phases = (np.arange(self.length) + 0.5) / self.length
        return np.asarray(0.1 + np.sin(np.pi * phases[:, None]))

    def extract(self, values: Array, starts: NDArray[np.intp]) -> Array:
        """Return the frames of these windows, shape (n_windows, length, n_channels)."""
        extract = sliding_window_view(values, self.length, axis=0)[starts]
        return np.asarray(extract.transpose(0, 2, 1))

    def coefficients_from_frames(self, frames: Array) -> Array:
        """Return the DCT coefficients of windows, shape (n_windows, length, n_channels).

        A product with all cosines takes a third of the time of a fast transform: windows are
        short, and channels many.
        """
        units = self.density * self.noise_deviations[:, None]
        return np.asarray((self._cosines.T / units) @ frames)

    def frames_from_coefficients(self, coefficients: Array) -> Array:
        """Invert `coefficients_from_frames`."""
        return np.asarray(self.dct_basis(self.length) @ coefficients)

    def add(self, total: Array, frames: Array, starts: NDArray[np.intp]) -> None:
        """Add windows (n, length, n_channels), or one at all starts, to a sum over the take."""
        frames = np.broadcast_to(frames * self._taper, (len(starts), *frames.shape[-2:]))
        indices = starts[:, None] + np.arange(self.length)
        n_overlaps = np.searchsorted(starts, starts + self.length) - np.arange(len(starts))
        step = int(n_overlaps.max())
        for first in range(step):  # so many windows apart, none overlaps another
            total[indices[first::step]] += frames[first::step]

    def dct_basis(self, n_coefficients: int) -> Array:
        """Return the slowest cosines, (length, n_coefficients), whose sums are the frames."""
        return np.asarray((self._cosines * self.noise_deviations)[:, :n_coefficients])

    @cached_property
    def noise_deviations(self) -> Array:
        """Deviation of the noise of each coefficient, relative to that of a sample: 1 for white
        noise. Shape (length,)."""
        return np.sqrt(self.noise_spectrum.variances(self.length))

    @cached_property
    def _cosines(self) -> Array:
        """The orthonormal discrete cosine transform, times the root of the density."""
        coefficients = np.arange(self.length)
        phases = (coefficients[:, None] + 0.5) * coefficients * (np.pi / self.length)
        scale = np.where(coefficients > 0, 2.0, 1.0) * self.density / self.length
        return np.asarray(np.cos(phases) * np.sqrt(scale))
