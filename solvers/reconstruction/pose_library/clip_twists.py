"""The twist of limbs in clean clips, whatever the makers' rest poses and axes."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...motion import Motion, Skeleton, find_humanoid_map, forward_kinematics
from ...motion.humanoid import POSTURE_JOINTS, t_pose_alignment
from ...rotations import multiply, rotate
from ..joint_rotations import (
    N_TWISTED_LIMBS,
    TWISTED_LIMBS,
    Complex,
    axial_angles,
    flexion_normals,
    flexion_weights,
    untwisted_hinges,
)

Array = NDArray[np.float64]

HALF_WEIGHT_COUNT = 20.0
"""Bent postures of a rig at which half of what its rotations say of straight limbs is
believed."""


class ClipTwists(NamedTuple):
    """What a clip tells of twist, each of shape (n_frames, 4).

    Attributes
    ----------
    rotated : complex
        Of length 1: by the rotations of upper arms and thighs, from the T-pose.
    bent : complex
        Of length 1: by the planes in which elbows and knees bend.
    shares : 0 to 1
        How far these planes are told.
    """

    rotated: Complex
    bent: Complex
    shares: Array


def read_clip_twists(motion: Motion, postures: Array) -> ClipTwists:
    """Read the twist of limbs from a clip.

    Parameters
    ----------
    motion : Motion
    postures : shape (n_frames, 20, 3), metres
        Its `motion_postures`.
    """
    humanoid = find_humanoid_map(motion.skeleton)
    joints = humanoid.indices(motion.skeleton)
    alignment = t_pose_alignment(motion.skeleton, humanoid)
    world = forward_kinematics(motion).rotations
    hinges = np.empty((motion.n_frames, N_TWISTED_LIMBS, 3))
    for place, limb in enumerate(TWISTED_LIMBS):
        joint = joints[POSTURE_JOINTS[limb.upper]]
        hinges[:, place] = rotate(multiply(world[:, joint], alignment[joint]), limb.hinge)
    directions, plain = untwisted_hinges(postures)
    normals, bends = flexion_normals(postures)
    rotated, bent = (axial_angles(directions, plain, each) for each in (hinges, normals))
    likely = 0.5 + 0.5 * np.nan_to_num(bent).real
    shares = np.where(np.isfinite(bent), flexion_weights(bends) * likely, 0.0)
    return ClipTwists(rotated, np.nan_to_num(bent), np.nan_to_num(shares))


def combine_clip_twists(
    skeletons: Sequence[Skeleton], clips: Sequence[ClipTwists]
) -> list[Complex]:
    """Return what clips tell of twist when each maker's constant offset is taken out.

    Where a limb bends, its plane tells the twist. By how much a maker's idea of the hinge is
    turned from that plane is the same in all postures of a rig, and is measured on all its
    clips; where a limb is straight, rotations without this offset tell the twist, as far as
    they agree with bends elsewhere.

    Returns
    -------
    list of complex arrays, shape (n_frames, 4)
        Points in the unit circle; shorter where less is known.
    """
    sums: dict[object, tuple[Complex, Array]] = {}
    keys = [_rig_key(skeleton) for skeleton in skeletons]
    for key, clip in zip(keys, clips, strict=True):
        off = np.nan_to_num(clip.bent * np.conj(clip.rotated))
        turns, weights = sums.get(
            key, (np.zeros(N_TWISTED_LIMBS, complex), np.zeros(N_TWISTED_LIMBS))
        )
        sums[key] = turns + (clip.shares * off).sum(axis=0), weights + clip.shares.sum(axis=0)
    found = []
    for key, clip in zip(keys, clips, strict=True):
        turns, weights = sums[key]
        straight = np.nan_to_num(clip.rotated) * (turns / (weights + HALF_WEIGHT_COUNT))
        found.append(clip.shares * clip.bent + (1.0 - clip.shares) * straight)
    return found


def _rig_key(skeleton: Skeleton) -> object:
    """Return what is the same for all clips of one rig; the sign of 0 is not."""
    return skeleton.names, (np.round(skeleton.offsets, 4) + 0.0).tobytes()
