"""Predict the error of joints with a model learned from simultaneous optical takes.

The model weighs two indicators, in meters: the distance of a joint from its own smoothed path,
and the length error of its segments. A joint at rest in a wrong position shows small
indicators, so the model misses it.
"""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from ...arrays import Array, Flags
from ...signals import fill_gaps
from .settings import SENSOR_RATE_HZ
from .terms import frame_count, vector_lengths, weighted_sum
from .transient_jumps import find_transient_jumps

SMOOTHING_WINDOW_S = 1.0 / 3.0
"""Window (s) of the polynomial that smooths the path. Half and twice gain less than 1 %
(`make sensitivity`)."""
DEGREE = 4
"""A count: degree of the polynomial that smooths the positions of a window. Half and twice are
no better (`make sensitivity`)."""
DEVIATION_WINDOW_S = 0.4
"""Window (s) over which deviations from the smoothed path are averaged. Chosen by hand;
`make sensitivity` varies it."""
LENGTH_WINDOW_S = 0.2
"""Window (s) over which length errors are averaged. Half and twice gain less than 1 %
(`make sensitivity`)."""
ONE_CENTIMETER = 0.01
"""Meters, added to errors before the logarithm is taken. Sweep: x0.5 costs 1.4 %, x2 costs 0.8
%."""
JUMP_DEVIATION_M = 0.05
"""Deviation (m) of a transient jump in averages, however far the joint jumped. Adjacent frames
are wrong more often than others, but mostly right. Half and twice gain less than 1 %
(`make sensitivity`)."""


@dataclass(frozen=True)
class ErrorModel:
    """Linear model: log(error + 1 cm) is normal about a line over the log of the indicators."""

    length_weight: float
    """Weight of a length error relative to a deviation from the smoothed path."""
    floor: float
    """Offset (m) added to the indicators before the logarithm."""
    level: float
    slope: float
    spread: float

    def combine(self, indicators: "ErrorIndicators") -> Array:
        """Return the logarithm of both indicators combined, shape (n_frames, n_joints)."""
        combined = np.hypot(indicators.deviation, self.length_weight * indicators.length_error)
        return np.asarray(np.log(combined + self.floor))

    def probability_within(self, indicators: "ErrorIndicators", tolerance: float) -> Array:
        """Return the probability, (n_frames, n_joints), of errors below a tolerance, meters."""
        expected = self.level + self.slope * self.combine(indicators)
        probability = scipy.special.ndtr(
            (np.log(tolerance + ONE_CENTIMETER) - expected) / self.spread
        )
        return np.where(indicators.jumps, 0.0, probability)


CENTERED_MODEL = ErrorModel(
    length_weight=0.15, floor=0.0005, level=-1.431, slope=0.395, spread=0.467
)
"""Model of the error's logarithm, meters, from frames on both sides. Learned by
`bench_reliability --fit` from all subjects of UI-PRMD."""
CAUSAL_MODEL = ErrorModel(
    length_weight=0.5, floor=0.001, level=-2.056, slope=0.344, spread=0.488
)
"""The same from earlier frames alone, meters. Learned by `bench_reliability --fit`, too."""


@dataclass(frozen=True, eq=False)
class ErrorIndicators:
    """Indicators of errors, shape (n_frames, n_joints), meters."""

    deviation: Array
    """Root mean square over `DEVIATION_WINDOW_S` of the distance from the smoothed path."""
    length_error: Array
    """Root mean square over `LENGTH_WINDOW_S` of the largest length error of adjacent segments.
    """
    jumps: Flags
    """Frames of transient jumps; averages ignore the size of the jump."""


def measure_error_indicators(
    positions: Array,
    length_errors: Array,
    parents: NDArray[np.intp],
    frame_rate: float,
    causal: bool,
) -> ErrorIndicators:
    """Measure the indicators of errors; 0 where nothing is measurable.

    Parameters
    ----------
    positions : shape (n_frames, n_joints, 3), meters
    length_errors : shape (n_frames, n_joints), meters
        Length error of the segment above each joint; NaN where unknown.
    parents : shape (n_joints,)
    frame_rate : float, hertz
    causal : bool
        If true, use past frames only, and second differences instead of a smoothed path.
        Transient jumps are then not detected, since they show only when the joint returns.
    """
    jumps = np.zeros(positions.shape[:2], bool)
    if not causal:
        jumps = find_transient_jumps(positions, frame_rate)
        positions = np.where(jumps[..., None], np.nan, positions)
        is_excluded = jumps | jumps[:, np.maximum(parents, 0)]
        length_errors = np.where(is_excluded, np.nan, length_errors)
    off = _second_differences if causal else _smoothing_residuals
    far = np.where(jumps, JUMP_DEVIATION_M, off(positions, frame_rate))
    deviation = _root_mean_square(far, DEVIATION_WINDOW_S, frame_rate, causal)
    max_errors = np.where(np.isfinite(length_errors), np.abs(length_errors), 0.0)
    at_segments = max_errors.copy()
    for joint, parent in enumerate(parents):
        if parent >= 0:
            np.maximum(max_errors[:, parent], at_segments[:, joint], out=max_errors[:, parent])
    length_error = _root_mean_square(max_errors, LENGTH_WINDOW_S, frame_rate, causal)
    return ErrorIndicators(deviation, length_error, jumps)


def _smoothing_residuals(positions: Array, frame_rate: float) -> Array:
    """Return distances from the smoothed path, (n_frames, n_joints); NaN where missing.

    Polynomials of the fourth degree smooth the path and follow fast movement (Savitzky and
    Golay 1964). The degree is lower where a slow camera has few frames in a window: a
    polynomial through all of them would follow every error.
    """
    from scipy.signal import savgol_filter  # takes a second to import: only when needed

    max_length = len(positions) - 1 + len(positions) % 2
    n_frames = min(2 * round(0.5 * SMOOTHING_WINDOW_S * frame_rate) + 1, max_length)
    degree = min(DEGREE, n_frames // 2)
    smooth = savgol_filter(np.nan_to_num(fill_gaps(positions)), n_frames, degree, axis=0)
    return vector_lengths(positions - smooth)


def _second_differences(positions: Array, frame_rate: float) -> Array:
    """Return the distance of joints from linear extrapolation; NaN where unknown."""
    step = frame_count(1.0 / SENSOR_RATE_HZ, frame_rate)
    off = np.full(positions.shape[:2], np.nan)
    if len(positions) > 2 * step:
        current, previous, earlier = (
            positions[2 * step :],
            positions[step:-step],
            positions[: -2 * step],
        )
        off[2 * step :] = vector_lengths(current - 2.0 * previous + earlier)
    return off


def _root_mean_square(values: Array, window: float, frame_rate: float, causal: bool) -> Array:
    """Average over known frames; the nearest frames have the largest weights."""
    is_known = np.isfinite(values)
    squares: Array = np.square(np.where(is_known, values, 0.0))
    n_averaged = frame_count(window, frame_rate)
    if causal:
        weights = np.linspace(1.0, 0.0, 2 * n_averaged, endpoint=False)
        total = weighted_sum(squares, weights, causal)
        weight_sums = weighted_sum(is_known.astype(np.float64), weights, causal)
        return np.asarray(np.sqrt(total / np.maximum(weight_sums, 1e-9)))
    n_averaged = 2 * (n_averaged // 2) + 1
    for _ in range(2):
        squares = scipy.ndimage.uniform_filter1d(squares, n_averaged, axis=0, mode="nearest")
    if is_known.all():
        return np.asarray(np.sqrt(np.maximum(squares, 0.0)))
    weight_sums = is_known.astype(np.float64)
    for _ in range(2):
        weight_sums = scipy.ndimage.uniform_filter1d(
            weight_sums, n_averaged, axis=0, mode="nearest"
        )
    return np.asarray(np.sqrt(np.maximum(squares, 0.0) / np.maximum(weight_sums, 1e-9)))
