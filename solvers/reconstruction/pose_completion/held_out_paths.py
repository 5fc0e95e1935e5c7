"""Estimate whether a joint keeps to its own path across a gap, from where it was observed."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array

SIMILAR_FRACTION = 0.2
"""Fraction, a ratio, of the hidden windows that count: those whose ends move most like those of
the gap. Sweep: x0.5 and x2 change 0.1 % of one figure
(`test_resting_joint_stays_where_it_was_though_the_library_errs`)."""
MIN_MOVEMENT_M = 0.05
"""Smallest movement (m, on each axis) that is not rest. Sweep on subjects 1 and 3 of UI-PRMD:
x3 costs 0.2 % (`test_library_pose_dominates_inside_a_long_gap`)."""
MAX_WINDOWS = 400
"""Maximum number of windows to hide. It bounds the run time: windows are evenly spaced."""


def rest_probability(
    tracked: Array, reliable: NDArray[np.bool_], gap: slice, away: Array, deviation: Array
) -> float:
    """Return the probability that a joint followed its interpolated path across a gap.

    Two states are compared. At rest, the library pose differs from the path by its own error.
    In motion, it differs by the movement as well: the largest difference decides. How often the
    joint stays on its path is counted where it was observed: windows of the gap's length, or
    shorter ones in a short take, are hidden and interpolated, and those count whose ends move
    most like the gap's.

    Parameters
    ----------
    tracked : shape (n_frames, 3), meters
    reliable : shape (n_frames,)
        False where the joint is not known.
    gap : slice
        With reliable frames before and after.
    away : shape (n_missing, 3), meters
        Library position minus interpolated one.
    deviation : shape (n_missing,), meters
        Expected error of the library position on each axis.

    Returns
    -------
    float
        0 where nothing was observed for long enough.
    """
    stays = _fraction_within(
        tracked, reliable, gap, float(np.sqrt(3.0 * (deviation**2).mean()))
    )
    if stays is None:
        return 0.0
    known = tracked[reliable]
    error = float((deviation**2).mean())
    movement = float(((known - known.mean(axis=0)) ** 2).mean())
    movement = max(movement, MIN_MOVEMENT_M**2)
    square = float((away**2).sum(axis=-1).max())
    ratio = error / (error + movement)
    log_odds = (
        np.log(stays / (1.0 - stays))
        - 1.5 * np.log(ratio)
        - 0.5 * square / error * (1.0 - ratio)
    )
    return float(1.0 / (1.0 + np.exp(-np.clip(log_odds, -50.0, 50.0))))


def _fraction_within(
    tracked: Array, reliable: NDArray[np.bool_], gap: slice, tolerance: float
) -> float | None:
    """Return the fraction of hidden windows whose interpolated path is within a tolerance."""
    counts = np.concatenate([[0], np.cumsum(reliable)])
    n_missing = gap.stop - gap.start
    while n_missing:
        span = n_missing + 4  # the window and two frames on each side
        starts = np.flatnonzero(counts[span:] - counts[:-span] == span)
        if len(starts):
            break
        n_missing //= 2
    else:
        return None
    if len(starts) > MAX_WINDOWS:
        starts = starts[np.linspace(0, len(starts) - 1, MAX_WINDOWS).round().astype(int)]
    ends = tracked[starts[:, None] + np.array([0, 1, span - 2, span - 1])]
    hidden = tracked[starts[:, None] + np.arange(2, span - 2)]
    squares = ((hermite_paths(ends, n_missing) - hidden) ** 2).sum(axis=-1).mean(axis=-1)
    around = [
        _known_frame(reliable, frame)
        for frame in (gap.start - 2, gap.start - 1, gap.stop, gap.stop + 1)
    ]
    wanted = _end_features(tracked[around][None], n_missing)
    distances = np.linalg.norm(_end_features(ends, n_missing) - wanted, axis=-1)
    n_similar = max(round(SIMILAR_FRACTION * len(starts)), 1)
    similar = np.argsort(distances, kind="stable")[:n_similar]
    n_stays = int((squares[similar] < tolerance**2).sum())
    return (n_stays + 1.0) / (len(similar) + 2.0)


def hermite_paths(ends: Array, n_missing: int) -> Array:
    """Return smooth paths across gaps with limited overshoot.

    Slopes are those of the parabola through the adjacent samples, at most three times those of
    the adjacent straight segments (Fritsch and Carlson 1980). The limit applies to vectors
    here, so that it does not depend on the axes.

    Parameters
    ----------
    ends : shape (n_windows, 4, 3), meters
        Two positions before each gap and two after it, at successive frames.
    n_missing : int

    Returns
    -------
    shape (n_windows, n_missing, 3)
    """
    length = n_missing + 1
    chord = (ends[:, 2] - ends[:, 1]) / length
    slopes = []
    for outer in (ends[:, 1] - ends[:, 0], ends[:, 3] - ends[:, 2]):
        slope = (length * outer + chord) / (length + 1)
        speeds = [np.linalg.norm(each, axis=-1) for each in (outer, chord, slope)]
        limit = 3.0 * np.minimum(speeds[0], speeds[1]) / np.maximum(speeds[2], 1e-12)
        slopes.append(slope * np.minimum(limit, 1.0)[:, None] * length)
    u = np.arange(1, length)[None, :, None] / length
    first, last = slopes[0][:, None], slopes[1][:, None]
    return np.asarray(
        (1.0 + 2.0 * u) * (1.0 - u) ** 2 * ends[:, 1, None]
        + u * (1.0 - u) ** 2 * first
        + u**2 * (3.0 - 2.0 * u) * ends[:, 2, None]
        + u**2 * (u - 1.0) * last
    )


def _end_features(ends: Array, n_missing: int) -> Array:
    """Return how far apart the ends of gaps are, and how far their speeds lead; (n, 3), m."""
    separation = np.linalg.norm(ends[:, 2] - ends[:, 1], axis=-1)
    before, after = (
        np.linalg.norm(ends[:, late] - ends[:, late - 1], axis=-1) * n_missing
        for late in (1, 3)
    )
    return np.stack([separation, before, after], axis=-1)


def _known_frame(reliable: NDArray[np.bool_], frame: int) -> int:
    """Return the nearest frame in which the joint is known."""
    known = np.flatnonzero(reliable)
    return int(known[np.abs(known - frame).argmin()])
