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
MIN_JOINT_RELIABILITY = 0.6
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
    has_parent = np.array(PARENTS) >= 0
    ratios = segment_lengths(positions)[:, has_parent] / ADULT_BONE_LENGTHS_M[has_parent]
    return float(np.nanmedian(ratios)) if np.isfinite(ratios).any() else np.nan


def estimate_bone_lengths(positions: Array, reliability: Array | None = None) -> Array:
    """Return the bone lengths of an actor, shape (20,), meters: medians of reliable frames.

    A bone that is never observed has the adult's length, scaled by the other bones.

    Parameters
    ----------
    positions : shape (n_frames, 20, 3), meters
        NaN: missing.
    reliability : shape (n_frames, 20), optional
        0 to 1. None: all frames count.
    """
    lengths = segment_lengths(positions)
    if reliability is not None:
        is_reliable = (
            np.minimum(reliability, reliability[:, np.maximum(PARENTS, 0)])
            > MIN_JOINT_RELIABILITY
        )
        n_reliable = (is_reliable & np.isfinite(lengths)).sum(axis=0)
        has_enough = n_reliable >= MIN_RELIABLE_FRAMES
        lengths = np.where(is_reliable | ~has_enough, lengths, np.nan)
    is_observed = np.isfinite(lengths).any(axis=0)
    median = np.median if np.isfinite(lengths).all() else np.nanmedian  # the first is faster
    medians = np.full(N_JOINTS, np.nan)
    medians[is_observed] = median(lengths[:, is_observed], axis=0)
    is_measured = is_observed & (ADULT_BONE_LENGTHS_M > 0.0)
    scale = (
        medians[is_measured].sum() / ADULT_BONE_LENGTHS_M[is_measured].sum()
        if is_measured.any()
        else 1.0
    )
    bone_lengths = np.where(is_observed, medians, scale * ADULT_BONE_LENGTHS_M)
    bone_lengths[HIPS] = 0.0
    return bone_lengths


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
    resized = lengths[:, None] * (bones / np.where(norms > 0.0, norms, 1.0))
    resized[..., HIPS, :] = postures[..., HIPS, :]
    gap_scale = None if np.isfinite(resized).all() else scale
    for joint in range(1, N_JOINTS):
        resized[..., joint, :] += resized[..., parents[joint], :]
        if gap_scale is not None:
            _attach_to_ancestor(resized, postures, joint, gap_scale)
    return np.asarray(resized)


def _attach_to_ancestor(resized: Array, postures: Array, joint: int, scale: float) -> None:
    """Place a joint with a missing parent relative to its nearest observed ancestor."""
    ancestor = PARENTS[joint]
    while ancestor > 0:
        ancestor = PARENTS[ancestor]
        displacement = postures[..., joint, :] - postures[..., ancestor, :]
        estimate = resized[..., ancestor, :] + scale * displacement
        position = resized[..., joint, :]
        resized[..., joint, :] = np.where(np.isfinite(position), position, estimate)
