"""How far a joint is probably off: learned from takes that an optical system saw as well.

Two signs are weighed, in metres: how far the joint is off its own smoothed path, and how far
the segments at it are off their lengths. Errors as large as these signs are not rare, but signs
are small where a joint is at rest in the wrong place: that is not seen here.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d
from scipy.special import ndtr

from ...signals import bridged
from .settings import SENSOR_RATE_HZ
from .terms import frame_count, vector_lengths, weighted_sum
from .transient_jumps import find_transient_jumps

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

SMOOTHING_WINDOW_S = 1.0 / 3.0
"""Seconds of a piece of path that is held to be a polynomial."""
DEGREE = 4
DEVIATION_WINDOW_S = 0.4
"""Seconds over which deviations from that path count for a joint."""
LENGTH_WINDOW_S = 0.2
"""Seconds over which errors of lengths count."""
ONE_CENTIMETER = 0.01
JUMP_DEVIATION_M = 0.05
"""Metres that a joint counts as off its path in means, however far it jumped away: frames
beside it are wrong more often than others, but mostly they are right."""


@dataclass(frozen=True)
class ErrorModel:
    """The logarithm of the error, plus a centimetre, is normal about a line over the signs'."""

    length_share: float
    """What an error of length counts, compared with a deviation from the smoothed path."""
    floor: float
    """Metres added to the signs before the logarithm is taken."""
    level: float
    slope: float
    spread: float

    def sign(self, signs: "ErrorIndicators") -> Array:
        """Return the logarithm of both signs together."""
        both = np.hypot(signs.deviation, self.length_share * signs.stretch)
        return np.asarray(np.log(both + self.floor))

    def chance_within(self, signs: "ErrorIndicators", tolerance: float) -> Array:
        """Return the probability that a joint is no farther off than that, in metres."""
        expected = self.level + self.slope * self.sign(signs)
        chance = ndtr((np.log(tolerance + ONE_CENTIMETER) - expected) / self.spread)
        return np.where(signs.away, 0.0, chance)


CENTERED_MODEL = ErrorModel(
    length_share=0.15, floor=0.0005, level=-1.431, slope=0.395, spread=0.467
)
CAUSAL_MODEL = ErrorModel(
    length_share=0.5, floor=0.001, level=-2.056, slope=0.344, spread=0.488
)
"""From all subjects of UI-PRMD: `bench_reliability --fit`."""


@dataclass(frozen=True, eq=False)
class ErrorIndicators:
    """What betrays errors, shape (n_frames, n_joints), metres."""

    deviation: Array
    """Root mean square over `AGITATED` of the distance from the smoothed path."""
    stretch: Array
    """The same over `STRETCHED` of the greatest error of length of the segments that meet."""
    away: Flags
    """Where a joint jumped away and comes back; how far does not count in means."""


def measure_error_indicators(
    positions: Array,
    wrong_lengths: Array,
    parents: NDArray[np.intp],
    frame_rate: float,
    causal: bool,
) -> ErrorIndicators:
    """Look for signs of errors; 0 where there is nothing to see.

    Parameters
    ----------
    positions : shape (n_frames, n_joints, 3), metres
    wrong_lengths : shape (n_frames, n_joints), metres
        How far the segment above each joint is off its length; NaN where that is not known.
    parents : shape (n_joints,)
    frame_rate : float, hertz
    causal : bool
        True: look at past frames only, and at second differences instead of a smoothed path;
        then it is not known yet that a joint which jumps away will come back.
    """
    away = np.zeros(positions.shape[:2], bool)
    if not causal:
        away = find_transient_jumps(positions, frame_rate)
        positions = np.where(away[..., None], np.nan, positions)
        odd = away | away[:, np.maximum(parents, 0)]
        wrong_lengths = np.where(odd, np.nan, wrong_lengths)
    off = _second_differences if causal else _smoothing_residuals
    far = np.where(away, JUMP_DEVIATION_M, off(positions, frame_rate))
    deviation = _root_mean_square(far, DEVIATION_WINDOW_S, frame_rate, causal)
    greatest = np.where(np.isfinite(wrong_lengths), np.abs(wrong_lengths), 0.0)
    at_segments = greatest.copy()
    for joint, parent in enumerate(parents):
        if parent >= 0:
            np.maximum(greatest[:, parent], at_segments[:, joint], out=greatest[:, parent])
    stretch = _root_mean_square(greatest, LENGTH_WINDOW_S, frame_rate, causal)
    return ErrorIndicators(deviation, stretch, away)


def _smoothing_residuals(positions: Array, frame_rate: float) -> Array:
    """Return distances from the smoothed path, (n_frames, n_joints); NaN where not seen.

    The path is smoothed with polynomials of the fourth degree, which follow a body however fast
    it goes (Savitzky and Golay 1964). The degree is lower where a slow camera has few frames
    in a piece: a polynomial through all of them would follow every error.
    """
    from scipy.signal import savgol_filter  # takes a second to import: only when needed

    longest = len(positions) - 1 + len(positions) % 2
    n_frames = min(2 * round(0.5 * SMOOTHING_WINDOW_S * frame_rate) + 1, longest)
    degree = min(DEGREE, n_frames // 2)
    smooth = savgol_filter(np.nan_to_num(bridged(positions)), n_frames, degree, axis=0)
    return vector_lengths(positions - smooth)


def _second_differences(positions: Array, frame_rate: float) -> Array:
    """Return how far a joint is from where its last two places led; NaN where not known."""
    step = frame_count(1.0 / SENSOR_RATE_HZ, frame_rate)
    off = np.full(positions.shape[:2], np.nan)
    if len(positions) > 2 * step:
        now, once, before = positions[2 * step :], positions[step:-step], positions[: -2 * step]
        off[2 * step :] = vector_lengths(now - 2.0 * once + before)
    return off


def _root_mean_square(values: Array, window: float, frame_rate: float, causal: bool) -> Array:
    """Average over what is known, most over the nearest frames."""
    known = np.isfinite(values)
    squares: Array = np.square(np.where(known, values, 0.0))
    n_averaged = frame_count(window, frame_rate)
    if causal:
        weights = np.linspace(1.0, 0.0, 2 * n_averaged, endpoint=False)
        total = weighted_sum(squares, weights, causal)
        share = weighted_sum(known.astype(np.float64), weights, causal)
        return np.asarray(np.sqrt(total / np.maximum(share, 1e-9)))
    n_averaged = 2 * (n_averaged // 2) + 1
    for _ in range(2):
        squares = uniform_filter1d(squares, n_averaged, axis=0, mode="nearest")
    if known.all():
        return np.asarray(np.sqrt(np.maximum(squares, 0.0)))
    share = known.astype(np.float64)
    for _ in range(2):
        share = uniform_filter1d(share, n_averaged, axis=0, mode="nearest")
    return np.asarray(np.sqrt(np.maximum(squares, 0.0) / np.maximum(share, 1e-9)))
