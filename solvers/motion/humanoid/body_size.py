"""Estimate the bone lengths of an actor, and resize postures to other lengths."""

import numpy as np

from ...arrays import Array
from .posture_joints import HIPS, N_JOINTS, PARENTS

ADULT_BONE_LENGTHS_M = np.array(
    [0.0, 0.28, 0.22, 0.27]
    + 2 * [0.19, 0.28, 0.25, 0.09]
    + 2 * [0.10, 0.42, 0.40, 0.15]
)  # fmt: skip
"""Distance of each joint from its parent in an adult of 1.75 m, meters (fractions of stature by
Drillis and Contini 1966; shoulders and hips as the Kinect places them)."""
ADULT_STATURE_M = 1.75
"""Stature of that adult. By definition."""
MAX_BODY_SCALE, MIN_BODY_SCALE = 3.0, 0.2
"""Scales of a body relative to that adult beyond which the unit must be wrong. They guard
against wrong units (`test_invalid_recordings_are_reported_in_one_sentence`)."""
MIN_RELIABILITY = 0.6
"""Joints above this reliability determine the lengths, if there are enough of them. It guards
actors who are hidden most of the time, with limbs of wrong lengths
(`test_unreliable_frames_do_not_change_bone_lengths`)."""
MIN_RELIABLE_FRAMES = 15
"""Number of reliable frames that determine the length of a bone, half a second of a depth
camera. It guards bones that are reliable in too few frames: all frames count then
(`test_few_reliable_frames_do_not_decide_bone_lengths`)."""


def segment_lengths(positions: Array) -> Array:
    """Return the distance of each joint from its parent, shape (n_frames, 20), meters."""
    parents = np.maximum(PARENTS, 0)
    return np.asarray(np.linalg.norm(positions - positions[..., parents, :], axis=-1))


def estimate_body_scale(positions: Array) -> float:
    """Return the scale of a body relative to an adult; NaN if no bone is observed.

    Parameters
    ----------
    positions : shape (n_frames, 20, 3), meters
    """
    bones = np.array(PARENTS) >= 0
    ratios = segment_lengths(positions)[:, bones] / ADULT_BONE_LENGTHS_M[bones]
    return float(np.nanmedian(ratios)) if np.isfinite(ratios).any() else np.nan


def estimate_bone_lengths(positions: Array, reliability: Array | None = None) -> Array:
    """Return the bone lengths of an actor, shape (20,), meters: medians of reliable frames.

    A bone that is never observed has the adult's length, scaled by the other bones.
    """
    lengths_per_frame = segment_lengths(positions)
    if reliability is not None:
        reliable = (
            np.minimum(reliability, reliability[:, np.maximum(PARENTS, 0)]) > MIN_RELIABILITY
        )
        enough = (reliable & np.isfinite(lengths_per_frame)).sum(axis=0) >= MIN_RELIABLE_FRAMES
        lengths_per_frame = np.where(reliable | ~enough, lengths_per_frame, np.nan)
    observed = np.isfinite(lengths_per_frame).any(axis=0)
    lengths = np.full(N_JOINTS, np.nan)
    median = (
        np.median if np.isfinite(lengths_per_frame).all() else np.nanmedian
    )  # the first is faster
    lengths[observed] = median(lengths_per_frame[:, observed], axis=0)
    measured = observed & (ADULT_BONE_LENGTHS_M > 0.0)
    scale = (
        lengths[measured].sum() / ADULT_BONE_LENGTHS_M[measured].sum()
        if measured.any()
        else 1.0
    )
    lengths = np.where(observed, lengths, scale * ADULT_BONE_LENGTHS_M)
    lengths[HIPS] = 0.0
    return lengths


def resize_postures(postures: Array, lengths: Array, scale: float | None = None) -> Array:
    """Set the length of every bone and keep its direction; the hips do not move.

    Parameters
    ----------
    postures : shape (..., 20, 3), meters
        NaN: missing.
    lengths : shape (20,), meters
    scale : float, optional
        Scale of the displacement from the nearest observed ancestor, for joints with a missing
        parent. None: all descendants of a missing joint become NaN.
    """
    parents = np.maximum(PARENTS, 0)
    bones = postures - postures[..., parents, :]
    norms = np.linalg.norm(bones, axis=-1, keepdims=True)
    result = lengths[:, None] * (bones / np.where(norms > 0.0, norms, 1.0))
    result[..., 0, :] = postures[..., 0, :]
    has_gaps = scale is not None and not np.isfinite(result).all()
    for joint in range(1, N_JOINTS):
        result[..., joint, :] += result[..., parents[joint], :]
        if has_gaps:
            _attach_to_ancestor(result, postures, joint, scale or 1.0)
    return np.asarray(result)


def _attach_to_ancestor(result: Array, postures: Array, joint: int, scale: float) -> None:
    """Place a joint with a missing parent relative to its nearest observed ancestor."""
    parents = PARENTS[joint]
    while parents > 0:
        parents = PARENTS[parents]
        displacement = postures[..., joint, :] - postures[..., parents, :]
        lengths_per_frame = result[..., joint, :]
        observed = result[..., parents, :] + scale * displacement
        result[..., joint, :] = np.where(
            np.isfinite(lengths_per_frame), lengths_per_frame, observed
        )
