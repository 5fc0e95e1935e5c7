"""Axial rotations of limbs in clean clips, independent of rest poses and bone axes."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ...motion import Motion, Skeleton, find_humanoid_map, forward_kinematics
from ...motion.humanoid import POSTURE_JOINTS, t_pose_alignment
from ...rotations import multiply, rotate
from ..joint_rotations import (
    HALF_WEIGHT_COUNT,
    N_TWISTED_LIMBS,
    TWISTED_LIMBS,
    Complex,
    axial_angles,
    flexion_normals,
    flexion_weights,
    untwisted_hinges,
)


class ClipTwists(NamedTuple):
    """Axial rotations of limbs in a clip, each of shape (n_frames, 4).

    Attributes
    ----------
    from_rotations : complex
        Of length 1: from the rotations of upper arms and thighs relative to the T-pose.
    from_flexion : complex
        Of length 1: from the flexion planes of elbows and knees.
    flexion_fractions : 0 to 1
        Weight of the flexion planes.
    """

    from_rotations: Complex
    from_flexion: Complex
    flexion_fractions: Array


def read_clip_twists(motion: Motion, postures: Array) -> ClipTwists:
    """Read the axial rotations of limbs from a clip.

    Parameters
    ----------
    motion : Motion
    postures : shape (n_frames, 20, 3), meters
        Its `postures_from_motion`.
    """
    humanoid = find_humanoid_map(motion.skeleton)
    joints = humanoid.indices(motion.skeleton)
    alignment = t_pose_alignment(motion.skeleton, humanoid)
    world = forward_kinematics(motion).rotations
    hinges = np.empty((motion.n_frames, N_TWISTED_LIMBS, 3))
    for index, limb in enumerate(TWISTED_LIMBS):
        joint = joints[POSTURE_JOINTS[limb.upper]]
        hinges[:, index] = rotate(multiply(world[:, joint], alignment[joint]), limb.hinge)
    directions, untwisted = untwisted_hinges(postures)
    normals, angles = flexion_normals(postures)
    from_rotations, from_flexion = (
        axial_angles(directions, untwisted, each) for each in (hinges, normals)
    )
    consistency = 0.5 + 0.5 * np.nan_to_num(from_flexion).real
    flexion_fractions = np.where(
        np.isfinite(from_flexion), flexion_weights(angles) * consistency, 0.0
    )
    return ClipTwists(
        from_rotations, np.nan_to_num(from_flexion), np.nan_to_num(flexion_fractions)
    )


def combine_clip_twists(
    skeletons: Sequence[Skeleton], clips: Sequence[ClipTwists]
) -> list[Complex]:
    """Combine the two estimates of axial rotation after removing each rig's constant offset.

    Where a limb is flexed, its flexion plane determines the axial rotation. A rig's hinge axes
    deviate from that plane by a constant angle, which is averaged over all its clips. Where a
    limb is straight, the rotations without this offset determine the axial rotation, weighted
    by their agreement with flexed frames.

    Returns
    -------
    list of complex arrays, shape (n_frames, 4)
        Points in the unit circle; shorter where less certain.
    """
    sums: dict[object, tuple[Complex, Array]] = {}
    keys = [_rig_key(skeleton) for skeleton in skeletons]
    for key, clip in zip(keys, clips, strict=True):
        offsets = np.nan_to_num(clip.from_flexion * np.conj(clip.from_rotations))
        offset_sum, weights = sums.get(
            key, (np.zeros(N_TWISTED_LIMBS, complex), np.zeros(N_TWISTED_LIMBS))
        )
        sums[key] = (
            offset_sum + (clip.flexion_fractions * offsets).sum(axis=0),
            weights + clip.flexion_fractions.sum(axis=0),
        )
    combined = []
    for key, clip in zip(keys, clips, strict=True):
        offset_sum, weights = sums[key]
        straight = np.nan_to_num(clip.from_rotations) * (
            offset_sum / (weights + HALF_WEIGHT_COUNT)
        )
        combined.append(
            clip.flexion_fractions * clip.from_flexion
            + (1.0 - clip.flexion_fractions) * straight
        )
    return combined


def _rig_key(skeleton: Skeleton) -> object:
    """Return a key common to all clips of one rig; it ignores the sign of zero."""
    return skeleton.names, (np.round(skeleton.offsets, 4) + 0.0).tobytes()
