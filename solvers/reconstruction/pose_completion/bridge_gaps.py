"""Short losses are bridged along the joint's own path, long ones by postures."""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

Array = NDArray[np.float64]

HALF_WEIGHT_S = 0.12
"""Seconds to what is seen on both sides (half their harmonic mean) at which a joint's own path
and the posture count alike. Movements that the library lacks want .25 (UI-PRMD), those that it
has want none; this lies between."""


def blend_short_gaps(
    seen: Array, sure: NDArray[np.bool_], rebuilt: Array, frame_rate: float
) -> Array:
    """Return rebuilt joints that near the borders of a loss follow the joint's own path.

    Parameters
    ----------
    seen : shape (n_frames, n_joints, 3), metres
        As tracked.
    sure : shape (n_frames, n_joints)
        Where what was seen is believed; false where it is NaN.
    rebuilt : shape (n_frames, n_joints, 3), metres
        As postures have them.
    frame_rate : float, hertz

    Returns
    -------
    NDArray, shape (n_frames, n_joints, 3)
        Beside and beyond what is believed on one side alone, that is `rebuilt`.
    """
    result = rebuilt.copy()
    frames = np.arange(len(seen))
    for joint in range(seen.shape[1]):
        known = frames[sure[:, joint]]
        if len(known) < 2:
            continue
        inside = frames[known[0] : known[-1] + 1]
        place = np.searchsorted(known, inside)
        before = inside - known[np.where(known[place] == inside, place, place - 1)]
        after = known[place] - inside
        whole = np.maximum(before + after, 1)
        near = before * after / (whole * frame_rate)
        share = (1.0 / (1.0 + (near / HALF_WEIGHT_S) ** 2))[:, None]
        path = _hermite_path(known, seen[known, joint])(inside)
        result[inside, joint] = share * path + (1.0 - share) * rebuilt[inside, joint]
    return result


def _hermite_path(frames: NDArray[np.int64], places: Array) -> CubicHermiteSpline:
    """Return a path through places that hardly swings out.

    Speeds are at most three times those of the straight lines beside (Fritsch and Carlson 1980;
    of vectors here, so that axes do not matter).
    """
    steps = np.diff(places, axis=0) / np.diff(frames)[:, None]
    speeds = np.linalg.norm(steps, axis=-1)
    slopes = np.gradient(places, frames.astype(np.float64), axis=0)
    least = np.minimum(np.append(speeds, speeds[-1]), np.insert(speeds, 0, speeds[0]))
    size = np.linalg.norm(slopes, axis=-1)
    limit = np.minimum(1.0, 3.0 * least / np.maximum(size, 1e-12))
    return CubicHermiteSpline(frames, places, slopes * limit[:, None])
