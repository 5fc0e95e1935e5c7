"""Filters of one channel at a time: (noisy (n_frames, n_channels), frame rate) -> same."""

from functools import lru_cache

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.linalg import cho_solve_banded, cholesky_banded, eigh
from scipy.ndimage import gaussian_filter1d, median_filter
from scipy.optimize import minimize_scalar
from scipy.signal import butter, filtfilt, savgol_filter

from solvers.arrays import Array

HAMPEL_HALF_WIDTH = 4
HAMPEL_THRESHOLD = 3.5


def unchanged(noisy: Array, frame_rate: float) -> Array:
    """Do nothing."""
    return noisy


def gaussian(noisy: Array, frame_rate: float, sigma_frames: float) -> Array:
    """Gaussian filter; [LC10] 2.3.2 uses one, 11 frames long."""
    return np.asarray(gaussian_filter1d(noisy, sigma_frames, axis=0, mode="nearest"))


def savitzky_golay(noisy: Array, frame_rate: float, length: int, order: int = 3) -> Array:
    """Least-squares polynomial in a moving window."""
    length = min(length, len(noisy) - 1 + len(noisy) % 2)
    return np.asarray(savgol_filter(noisy, length, min(order, length - 1), axis=0))


def butterworth(noisy: Array, frame_rate: float, cutoff: float = 6.0) -> Array:
    """Low-pass filter of gait analysis: second order, forwards and backwards, so without lag.

    The cut-off, hertz, is that of both passes together (Winter 2009, section 2.2.4.4).
    """
    single_pass = cutoff / (np.sqrt(2.0) - 1.0) ** 0.25
    numerator, denominator = butter(2, min(single_pass, 0.49 * frame_rate), fs=frame_rate)
    padding = min(3 * len(denominator), len(noisy) - 1)
    return np.asarray(filtfilt(numerator, denominator, noisy, axis=0, padlen=padding))


def hampel(noisy: Array, frame_rate: float) -> Array:
    """Replace what is far from the median of its neighbors by that median."""
    size = (2 * HAMPEL_HALF_WIDTH + 1, 1)
    center = median_filter(noisy, size=size, mode="nearest")
    padded = np.pad(noisy, [(HAMPEL_HALF_WIDTH,) * 2, (0, 0)], mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, size[0], axis=0)
    spread = 1.4826 * np.median(np.abs(windows - center[..., None]), axis=-1)
    return np.where(np.abs(noisy - center) > HAMPEL_THRESHOLD * spread + 1e-9, center, noisy)


def gcv_spline(noisy: Array, frame_rate: float) -> Array:
    """Natural cubic smoothing spline, smoothness per channel by generalised cross-validation.

    The same spline and the same search as `scipy.interpolate.make_smoothing_spline` (frames as
    abscissae), in the basis in which the smoother is diagonal (Demmler and Reinsch 1975): a
    hundred times faster. `test_peers.py` compares the two.
    """
    return _smoothed(noisy, *demmler_reinsch(tuple(np.arange(len(noisy), dtype=float))))


def hampel_gcv_spline(noisy: Array, frame_rate: float) -> Array:
    """Hampel filter, then the spline: the best that an animator could put together."""
    return gcv_spline(hampel(noisy, frame_rate), frame_rate)


def gcv_spline_over_gaps(gapped: Array, frame_rate: float) -> Array:
    """Smoothing spline through observed samples (NaN = missing), which also bridges gaps."""
    result = gapped.copy()
    patterns, which = np.unique(np.isfinite(gapped), axis=1, return_inverse=True)
    for number in np.flatnonzero(patterns.sum(axis=0) > 3):
        observed, columns = patterns[:, number], np.flatnonzero(which.ravel() == number)
        times = np.flatnonzero(observed).astype(float)
        smooth = _smoothed(gapped[np.ix_(observed, columns)], *demmler_reinsch(tuple(times)))
        natural = CubicSpline(times, smooth, bc_type="natural")
        result[:, columns] = natural(np.arange(len(gapped)))
    return result


def _smoothed(noisy: Array, basis: Array, roughness: Array) -> Array:
    coefficients = basis.T @ noisy

    def score(smoothness: float, power: Array) -> float:
        left = 1.0 - 1.0 / (1.0 + smoothness * roughness)
        return float((left**2 @ power) / left.sum() ** 2)

    result = np.empty_like(noisy)
    for channel, each in enumerate(coefficients.T):
        bounds = (0, len(noisy))
        found = minimize_scalar(score, args=(each**2,), bounds=bounds, method="bounded")
        result[:, channel] = basis @ (each / (1.0 + found.x * roughness))
    return result


@lru_cache(maxsize=8)
def demmler_reinsch(times: tuple[float, ...]) -> tuple[Array, Array]:
    """Eigenvectors and eigenvalues of Q R^-1 Q^T (Green and Silverman 1994, section 2.1.2)."""
    n_times, steps = len(times), np.diff(times)
    rows = np.arange(n_times - 2)
    Q = np.zeros((n_times, n_times - 2))
    Q[rows, rows] = 1.0 / steps[:-1]
    Q[rows + 1, rows] = -1.0 / steps[:-1] - 1.0 / steps[1:]
    Q[rows + 2, rows] = 1.0 / steps[1:]
    R = np.zeros((2, n_times - 2))
    R[0, 1:] = steps[1:-1] / 6.0
    R[1] = (steps[:-1] + steps[1:]) / 3.0
    K = Q @ cho_solve_banded((cholesky_banded(R), False), Q.T)
    roughness, basis = eigh(0.5 * (K + K.T))
    return basis, np.maximum(roughness, 0.0)
