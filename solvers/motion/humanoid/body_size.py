"""How long the bones of an actor are, and postures on a body of other lengths."""

import numpy as np
from numpy.typing import NDArray

from .posture_joints import HIPS, N_JOINTS, PARENTS

Array = NDArray[np.float64]

ADULT_BONE_LENGTHS_M = np.array(
    [0.0, 0.28, 0.22, 0.27]
    + 2 * [0.19, 0.28, 0.25, 0.09]
    + 2 * [0.10, 0.42, 0.40, 0.15]
)  # fmt: skip
"""Metres of the way to each joint from the one above, in an adult of 1.75 m
(Drillis and Contini's shares of stature, and the Kinect's flat shoulders and hips)."""
ADULT_STATURE_M = 1.75
"""Metres, of that adult."""
MAX_BODY_SCALE, MIN_BODY_SCALE = 3.0, 0.2
"""Sizes of a body, in such adults, beyond which the unit must be wrong."""
MIN_RELIABILITY = 0.6
"""Joints that are trusted more than this tell the lengths, where there are enough of them."""
MIN_RELIABLE_FRAMES = 15


def segment_lengths(positions: Array) -> Array:
    """Return the way from the joint above to each joint, shape (n_frames, 20), metres."""
    above = np.maximum(PARENTS, 0)
    return np.asarray(np.linalg.norm(positions - positions[..., above, :], axis=-1))


def estimate_body_scale(positions: Array) -> float:
    """Return how many times as large as an adult a body is; NaN where no bone is seen.

    Parameters
    ----------
    positions : shape (n_frames, 20, 3), metres
    """
    bones = np.array(PARENTS) >= 0
    shares = segment_lengths(positions)[:, bones] / ADULT_BONE_LENGTHS_M[bones]
    return float(np.nanmedian(shares)) if np.isfinite(shares).any() else np.nan


def estimate_bone_lengths(positions: Array, reliability: Array | None = None) -> Array:
    """Return the lengths of an actor's bones, shape (20,), metres: medians of reliable frames.

    A bone that is never seen has its usual share of the size of the others.
    """
    found = segment_lengths(positions)
    if reliability is not None:
        sure = np.minimum(reliability, reliability[:, np.maximum(PARENTS, 0)]) > MIN_RELIABILITY
        enough = (sure & np.isfinite(found)).sum(axis=0) >= MIN_RELIABLE_FRAMES
        found = np.where(sure | ~enough, found, np.nan)
    seen = np.isfinite(found).any(axis=0)
    lengths = np.full(N_JOINTS, np.nan)
    median = np.median if np.isfinite(found).all() else np.nanmedian  # the first is faster
    lengths[seen] = median(found[:, seen], axis=0)
    known = seen & (ADULT_BONE_LENGTHS_M > 0.0)
    share = lengths[known].sum() / ADULT_BONE_LENGTHS_M[known].sum() if known.any() else 1.0
    lengths = np.where(seen, lengths, share * ADULT_BONE_LENGTHS_M)
    lengths[HIPS] = 0.0
    return lengths


def resize_postures(postures: Array, lengths: Array, scale: float | None = None) -> Array:
    """Give every bone its length and leave it its direction; the hips stay.

    Parameters
    ----------
    postures : shape (..., 20, 3), metres
        NaN where not tracked.
    lengths : shape (20,), metres
    scale : float, optional
        By which the way from the nearest joint above that was tracked is scaled, for what
        hangs on a joint that was not; without it all below such a joint becomes NaN.
    """
    above = np.maximum(PARENTS, 0)
    bones = postures - postures[..., above, :]
    sizes = np.linalg.norm(bones, axis=-1, keepdims=True)
    result = lengths[:, None] * (bones / np.where(sizes > 0.0, sizes, 1.0))
    result[..., 0, :] = postures[..., 0, :]
    broken = scale is not None and not np.isfinite(result).all()
    for joint in range(1, N_JOINTS):
        result[..., joint, :] += result[..., above[joint], :]
        if broken:
            _hang_on_those_above(result, postures, joint, scale or 1.0)
    return np.asarray(result)


def _hang_on_those_above(result: Array, postures: Array, joint: int, scale: float) -> None:
    """Put a joint whose bone is not whole where it was seen from the nearest joint above."""
    above = PARENTS[joint]
    while above > 0:
        above = PARENTS[above]
        way = postures[..., joint, :] - postures[..., above, :]
        found = result[..., joint, :]
        seen = result[..., above, :] + scale * way
        result[..., joint, :] = np.where(np.isfinite(found), found, seen)
