"""Tell what a signal does from what disturbs it: a local fit that ignores outliers."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import correlate1d

from .noise import MAD_TO_SIGMA, estimate_noise

Array = NDArray[np.float64]

N_REFITS = 8
MAX_WEIGHT_CHANGE = 0.02
"""Weights that change by less than this are final."""
TUKEY_SIGMAS = 4.685
"""Residuals beyond this many standard deviations lose all weight (95 % efficiency)."""


@dataclass(frozen=True, eq=False)
class LowessFit:
    """How far a signal is from its own smooth course.

    Attributes
    ----------
    residual : shape (n_frames, n_components), the signal's unit
        What is left when the robust local fit is taken away; NaN where nothing was observed.
    scale : float, the signal's unit
        Robust standard deviation of one component of the noise, outliers left out.
    """

    residual: Array
    scale: float

    @property
    def deviation(self) -> Array:
        """Distance from the smooth course, shape (n_frames,)."""
        return np.asarray(np.linalg.norm(self.residual, axis=1))

    def spikes(self, threshold: float) -> NDArray[np.bool_]:
        """Return the frames that jump away by more than `threshold` and jump back.

        A quick but honest movement (a foot that strikes the floor) leaves the smooth course
        gradually; a spike enters and leaves with steps of half its height or more.
        """
        found = np.zeros(len(self.residual), dtype=np.bool_)
        steps = np.linalg.norm(np.diff(self.residual, axis=0), axis=1)
        steps = np.concatenate([[np.inf], np.where(np.isnan(steps), np.inf, steps), [np.inf]])
        height = np.nan_to_num(self.deviation)
        for start, stop in find_runs(height > threshold):
            half = 0.5 * height[start:stop].max()
            found[start:stop] = steps[start] > half and steps[stop] > half
        return found


def find_runs(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return (start, stop) of every stretch of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]])))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def fit_lowess(signal: Array, half_window: int, smallest: float) -> LowessFit:
    """Compare a signal with a robust local quadratic through its neighbourhood.

    Around each frame a parabola is fitted by iteratively reweighted least squares (Cleveland
    1979, LOWESS, doi:10.1080/01621459.1979.10481038) with tricube weights over time and
    bisquare weights that reject outliers. The components of one frame share one weight.

    Parameters
    ----------
    signal : shape (n_frames, n_components); NaN marks frames that were not observed
    half_window : int, frames
        Reach of the fit to either side; spikes up to a third of the window are seen whole.
    smallest : float, the signal's unit
        Deviations that are never called outliers, however clean the rest of the signal is.
    """
    known = np.isfinite(signal).all(axis=1)
    signal = np.where(known[:, None], signal, 0.0)
    offsets = np.arange(-half_window, half_window + 1) / (half_window + 1)
    window = (1.0 - np.abs(offsets) ** 3) ** 3
    weights = known.astype(np.float64)
    residual = signal
    for _ in range(N_REFITS):
        residual = signal - _local_fit(signal, weights, offsets, window)
        distance = np.linalg.norm(residual, axis=1)
        cut = TUKEY_SIGMAS * MAD_TO_SIGMA * _median(distance[known])
        before, weights = weights, known * _bisquare(distance / max(cut, smallest))
        if np.abs(weights - before).max() < MAX_WEIGHT_CHANGE:
            break
    residual = np.where(known[:, None], residual, np.nan)
    noise = estimate_noise(np.where(weights[:, None] > 0.0, signal, np.nan))
    return LowessFit(residual, float(np.sqrt(np.mean(noise**2))))


def _bisquare(distance: Array) -> Array:
    """Return Tukey's weights, which vanish from distance 1 on."""
    return np.asarray(np.maximum(0.0, 1.0 - distance**2) ** 2)


def _local_fit(signal: Array, weights: Array, offsets: Array, window: Array) -> Array:
    """Value at each frame of the weighted parabola around it; a mean where few are known."""

    def moment(values: Array, power: int) -> Array:
        kernel = window * offsets**power
        return np.asarray(correlate1d(values, kernel, axis=0, mode="constant"))

    s0, s1, s2, s3, s4 = (moment(weights, power)[:, None] for power in range(5))
    weighted = weights[:, None] * signal
    t0, t1, t2 = (moment(weighted, power) for power in range(3))
    # First row of the adjugate of the normal equations: Cramer's rule for the value at 0.
    c0, c1, c2 = s2 * s4 - s3**2, s2 * s3 - s1 * s4, s1 * s3 - s2**2
    determinant = s0 * c0 + s1 * c1 + s2 * c2
    enough = determinant > 1e-6 * np.maximum(s0, 1e-6) ** 3
    parabola = (c0 * t0 + c1 * t1 + c2 * t2) / np.where(enough, determinant, 1.0)
    mean = t0 / np.where(s0 > 1e-9, s0, 1.0)
    alone = np.where(s0 > 1e-9, mean, signal)
    return np.where(enough, parabola, alone)


def _median(values: Array) -> float:
    return float(np.median(values)) if len(values) else 0.0
