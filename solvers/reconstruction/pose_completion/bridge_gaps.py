"""Blend completed joints with their own interpolated paths, by the expected error of each."""

import numpy as np
import scipy
from numpy.typing import NDArray

from ...arrays import Array
from ...signals import find_runs
from .held_out_paths import rest_probability

HALF_WEIGHT_S = 0.12
"""Gap time (s) at which the joint's own path and the library pose have equal weight, if the
joint moves. The gap time is half the harmonic mean of the times to the nearest reliable frames.
Sweep on UI-PRMD: movements outside the library are best with 0.25 s, movements inside it with
0."""


def blend_gaps(
    tracked: Array,
    reliable: NDArray[np.bool_],
    rebuilt: Array,
    deviation: Array,
    frame_rate: float,
) -> Array:
    """Blend completed joints with the joint's own path across each gap.

    A joint that rests follows its path, and the probability that it rests is estimated on the
    take (`rest_probability`). Otherwise the weight of the path falls with the time to the ends
    of the gap.

    Parameters
    ----------
    tracked : shape (n_frames, n_joints, 3), meters
        Tracked positions.
    reliable : shape (n_frames, n_joints)
        Reliable observations; false where a position is NaN.
    rebuilt : shape (n_frames, n_joints, 3), meters
        Positions from library poses.
    deviation : shape (n_frames, n_joints), meters
        Expected error of `rebuilt` on each axis.
    frame_rate : float, hertz

    Returns
    -------
    NDArray, shape (n_frames, n_joints, 3)
        Equal to `rebuilt` without reliable frames on both sides.
    """
    result = rebuilt.copy()
    for joint in range(tracked.shape[1]):
        known = np.flatnonzero(reliable[:, joint])
        if len(known) < 2:
            continue
        inside = slice(known[0], known[-1] + 1)
        frames = np.arange(inside.start, inside.stop)
        weight = _weight_by_time(known, frames, frame_rate)
        path = _hermite_path(known, tracked[known, joint])(frames)
        for start, stop in find_runs(~reliable[inside, joint]):
            gap = slice(start + known[0], stop + known[0])
            rest = rest_probability(
                tracked[:, joint],
                reliable[:, joint],
                gap,
                rebuilt[gap, joint] - path[start:stop],
                deviation[gap, joint],
            )
            weight[start:stop] = rest + (1.0 - rest) * weight[start:stop]
        result[inside, joint] += weight[:, None] * (path - rebuilt[inside, joint])
    return result


def _weight_by_time(
    known: NDArray[np.intp], frames: NDArray[np.intp], frame_rate: float
) -> Array:
    """Return the weight of the path in each frame: 1 at reliable ones, less far from them."""
    following = np.searchsorted(known, frames)
    before = frames - known[np.where(known[following] == frames, following, following - 1)]
    after = known[following] - frames
    gap_time = before * after / (np.maximum(before + after, 1) * frame_rate)
    return np.asarray(1.0 / (1.0 + (gap_time / HALF_WEIGHT_S) ** 2))


def _hermite_path(
    frames: NDArray[np.intp], positions: Array
) -> "scipy.interpolate.CubicHermiteSpline":
    """Return a smooth path through positions with limited overshoot.

    Slopes are at most three times those of the adjacent straight segments (Fritsch and Carlson
    1980). The limit applies to vectors here, so that it does not depend on the axes.
    """
    steps = np.diff(positions, axis=0) / np.diff(frames)[:, None]
    speeds = np.linalg.norm(steps, axis=-1)
    slopes = np.gradient(positions, frames.astype(np.float64), axis=0)
    slower = np.minimum(np.append(speeds, speeds[-1]), np.insert(speeds, 0, speeds[0]))
    slope_sizes = np.linalg.norm(slopes, axis=-1)
    scale = np.minimum(1.0, 3.0 * slower / np.maximum(slope_sizes, 1e-12))
    return scipy.interpolate.CubicHermiteSpline(frames, positions, slopes * scale[:, None])
