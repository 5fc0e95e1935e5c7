"""Separate a smooth signal from spikes and noise by a robust local fit (LOWESS)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from .noise import MAD_TO_SIGMA, estimate_noise

N_REFITS = 8
"""Refits after which the reweighting ends. Half and twice gain less than 1 %
(`make sensitivity`)."""
MAX_WEIGHT_CHANGE = 0.02
"""Change of the weights below which the iteration has converged. Half and twice gain less than
1 % (`make sensitivity`)."""
TUKEY_SIGMAS = 4.685
"""Standard deviations beyond which a residual has no weight (95 % efficiency)."""


@dataclass(frozen=True, eq=False)
class LowessFit:
    """Residuals of a signal about its robust local fit.

    Attributes
    ----------
    residual : shape (n_frames, n_components), the signal's unit
        Signal minus the robust local fit; NaN where missing.
    scale : float, the signal's unit
        Standard deviation of one component of the noise, without outliers.
    """

    residual: Array
    scale: float

    @property
    def deviation(self) -> Array:
        """Distance from the fit, shape (n_frames,)."""
        return np.asarray(np.linalg.norm(self.residual, axis=1))

    def spikes(self, threshold: float) -> NDArray[np.bool_]:
        """Return the frames of transient outliers larger than `threshold`, shape (n_frames,).

        A fast but genuine movement, such as a foot strike, leaves the fit gradually, and a
        fast turn within a few frames continues in the frames around it. A spike begins and
        ends with steps of half its height or more, and is as high above the cubic through two
        frames on either side.
        """
        is_spike = np.zeros(len(self.residual), dtype=np.bool_)
        steps = np.linalg.norm(np.diff(self.residual, axis=0), axis=1)
        steps = np.concatenate([[np.inf], np.where(np.isnan(steps), np.inf, steps), [np.inf]])
        height = np.nan_to_num(self.deviation)
        for start, stop in find_runs(height > threshold):
            half = 0.5 * height[start:stop].max()
            above = self.residual[start:stop] - self._bridge(start, stop)
            is_high = np.linalg.norm(above, axis=1).max() > threshold
            is_spike[start:stop] = steps[start] > half and steps[stop] > half and is_high
        return is_spike

    def _bridge(self, start: int, stop: int) -> Array:
        """Return the polynomial through up to two frames on either side of a run.

        Zero where there is no frame on one side.
        """
        knots = np.array([start - 2, start - 1, stop, stop + 1])
        is_known = (knots >= 0) & (knots < len(self.residual))
        is_known[is_known] = np.isfinite(self.residual[knots[is_known]]).all(axis=1)
        frames = np.arange(start, stop)
        if not (is_known[:2].any() and is_known[2:].any()):
            return np.zeros((len(frames), self.residual.shape[1]))
        knots = knots[is_known]
        powers = np.arange(len(knots))
        middle = 0.5 * (start + stop)
        coefficients = np.linalg.solve(
            (knots - middle)[:, None] ** powers, self.residual[knots]
        )
        return np.asarray((frames - middle)[:, None] ** powers @ coefficients)


def find_runs(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return (start, stop) of every run of True in flags of shape (n,)."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]])))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def merge_runs(runs: list[tuple[int, int]], max_gap: int) -> list[tuple[int, int]]:
    """Join runs that are at most `max_gap` frames apart."""
    merged: list[tuple[int, int]] = []
    for start, stop in runs:
        if merged and start - merged[-1][1] <= max_gap:
            merged[-1] = (merged[-1][0], stop)
        else:
            merged.append((start, stop))
    return merged


def fit_lowess(signal: Array, half_window: int, min_scale: float) -> LowessFit:
    """Fit a robust local quadratic to a signal and return the residuals.

    Each frame gets a parabola through its neighbors, fitted by iteratively reweighted least
    squares (Cleveland 1979, LOWESS, doi:10.1080/01621459.1979.10481038). Weights are tricube
    over time, and bisquare to reject outliers. The components of a frame share one weight.

    Parameters
    ----------
    signal : shape (n_frames, n_components); NaN marks missing frames
    half_window : int, frames
        Half the window of the fit; spikes up to a third of the window are found completely.
    min_scale : float, the signal's unit
        Lower bound of the outlier cutoff: smaller residuals are never outliers.
    """
    observed = np.isfinite(signal).all(axis=1)
    signal = np.where(observed[:, None], signal, 0.0)
    offsets = np.arange(-half_window, half_window + 1) / (half_window + 1)
    window = (1.0 - np.abs(offsets) ** 3) ** 3
    weights = observed.astype(np.float64)
    residual = signal
    for _ in range(N_REFITS):
        residual = signal - _local_fit(signal, weights, offsets, window)
        distance = np.linalg.norm(residual, axis=1)
        cutoff = TUKEY_SIGMAS * MAD_TO_SIGMA * _median(distance[observed])
        previous, weights = weights, observed * _bisquare(distance / max(cutoff, min_scale))
        if np.abs(weights - previous).max() < MAX_WEIGHT_CHANGE:
            break
    residual = np.where(observed[:, None], residual, np.nan)
    noise = estimate_noise(np.where(weights[:, None] > 0.0, signal, np.nan))
    return LowessFit(residual, float(np.sqrt(np.mean(noise**2))))


def _bisquare(distance: Array) -> Array:
    """Return Tukey's biweight, which is zero from distance 1."""
    return np.asarray(np.maximum(0.0, 1.0 - distance**2) ** 2)


def _local_fit(signal: Array, weights: Array, offsets: Array, window: Array) -> Array:
    """Return the weighted parabola at each frame.

    Where too few frames are valid, it passes through those that are, such as two frames, and
    the others get their mean.
    """

    from scipy.ndimage import correlate1d  # slow to import: only when needed

    def moment(values: Array, power: int) -> Array:
        kernel = window * offsets**power
        return np.asarray(correlate1d(values, kernel, axis=0, mode="constant"))

    s0, s1, s2, s3, s4 = (moment(weights, power)[:, None] for power in range(5))
    weighted = weights[:, None] * signal
    t0, t1, t2 = (moment(weighted, power) for power in range(3))
    # First row of the adjugate of the normal equations: Cramer's rule for the value at 0.
    c0, c1, c2 = s2 * s4 - s3**2, s2 * s3 - s1 * s4, s1 * s3 - s2**2
    determinant = s0 * c0 + s1 * c1 + s2 * c2
    well_posed = determinant > 1e-6 * np.maximum(s0, 1e-6) ** 3
    parabola = (c0 * t0 + c1 * t1 + c2 * t2) / np.where(well_posed, determinant, 1.0)
    mean = t0 / np.where(s0 > 1e-9, s0, 1.0)
    fallback = np.where((s0 > 1e-9) & (weights[:, None] == 0.0), mean, signal)
    return np.where(well_posed, parabola, fallback)


def _median(values: Array) -> float:
    return float(np.median(values)) if len(values) else 0.0
