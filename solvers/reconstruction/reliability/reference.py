"""Segment lengths of a body, from reliable frames."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Flags
from ...motion.humanoid import MIN_JOINT_RELIABILITY, SIDES, posture_joint_indices
from .terms import vector_lengths

OUT, DOWN = (1.0, 0.0), (0.0, -1.0)
ARMS = (("UpperArm", "LowerArm"), ("LowerArm", "Hand"))
LEGS = (("UpperLeg", "LowerLeg"), ("LowerLeg", "Foot"))
MAX_ANGLE_DEG = 30.0
"""Largest angle (degrees) between a limb and its direction in a reference pose. Half and twice
are no better (`make sensitivity`)."""
MIN_FRAMES = 5
"""Minimum number of frames for a length. Half and twice are no better (`make sensitivity`)."""


def parent_distances(positions: Array, parents: NDArray[np.intp]) -> Array:
    """Return the distance of each joint to its parent, (n_frames, n_joints); NaN for roots."""
    lengths = vector_lengths(positions - positions[:, np.maximum(parents, 0)])
    return np.where(parents >= 0, lengths, np.nan)


def reference_lengths(lengths: Array, postures: Flags, reliability: Array) -> Array:
    """Return the expected length of each segment, shape (n_joints,), meters.

    The median over reference poses. Where these are rare, over frames in which the segment is
    reliable; where these are rare too, over all frames.

    Parameters
    ----------
    lengths : shape (n_frames, n_joints), meters
    postures : shape (n_frames,)
        Frames with a reference pose.
    reliability : shape (n_frames, n_joints)
        Reliability of each segment without the kinematics term.
    """
    chosen = np.broadcast_to(postures[:, None], lengths.shape) & (
        reliability > MIN_JOINT_RELIABILITY
    )
    for wider in (reliability > MIN_JOINT_RELIABILITY, np.ones_like(chosen)):
        is_rare = (chosen & np.isfinite(lengths)).sum(axis=0) < MIN_FRAMES
        chosen = np.where(is_rare, wider, chosen)
    reference = np.full(lengths.shape[1], np.nan)
    chosen_lengths = np.where(chosen, lengths, np.nan)
    has_length = np.isfinite(chosen_lengths).any(axis=0)
    reference[has_length] = np.nanmedian(chosen_lengths[:, has_length], axis=0)
    return reference


def find_reference_postures(names: Sequence[str], positions: Array, tracked: Flags) -> Flags:
    """Return the frames with arms down or in a T-pose [SHJT13, IV-B].

    Limbs are compared in the plane of the body, whose up direction is from the hips to the
    point between the shoulders. The result depends neither on heading nor on camera tilt. All
    joints must be tracked.

    Parameters
    ----------
    names : of the joints
    positions : shape (n_frames, n_joints, 3), meters
    tracked : shape (n_frames, n_joints)
    """
    roles = posture_joint_indices(names)
    needed = {"hips", "chest"} | {
        f"{side}{part}" for side in SIDES for bone in (*ARMS, *LEGS) for part in bone
    }
    if not needed <= roles.keys():
        return np.zeros(len(positions), bool)
    body = {role: positions[:, index] for role, index in roles.items()}
    up = _unit_vectors(body["chest"] - body["hips"])
    left = body["leftUpperArm"] - body["rightUpperArm"]
    left = _unit_vectors(left - (left * up).sum(axis=-1, keepdims=True) * up)
    standing = _matches_posture(body, up, left, DOWN)
    t_pose = _matches_posture(body, up, left, OUT)
    return np.asarray((standing | t_pose) & tracked.all(axis=1))


def _matches_posture(
    body: dict[str, Array], up: Array, left: Array, arms: tuple[float, float]
) -> Flags:
    """Return the frames in which legs point down and arms in the given direction."""
    matches = np.ones(len(up), bool)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        for bones, (out, rise) in ((ARMS, arms), (LEGS, DOWN)):
            expected = sign * out * left + rise * up
            for start, stop in bones:
                bone = _unit_vectors(body[side + stop] - body[side + start])
                matches &= (bone * expected).sum(axis=-1) > np.cos(np.radians(MAX_ANGLE_DEG))
    return matches


def _unit_vectors(vectors: Array) -> Array:
    lengths = vector_lengths(vectors)[:, None]
    return np.asarray(vectors / np.where(lengths > 0.0, lengths, np.nan))
