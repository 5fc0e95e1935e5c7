"""Fit positions to bone lengths, and transfer a motion to a skeleton of other lengths."""

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ..skeletons import Motion, Skeleton
from .foot_contacts import leg_length
from .roles import HumanoidMap, find_humanoid_map


def fit_bone_lengths(positions: NDArray[np.float64], skeleton: Skeleton) -> NDArray[np.float64]:
    """Move joints along their bones so that every bone has the length of the skeleton.

    Parameters
    ----------
    positions : shape (n_frames, n_joints, 3), meters
        Joints of a body with this skeleton's hierarchy; NaN: missing.
    skeleton : Skeleton

    Returns
    -------
    NDArray, shape (n_frames, n_joints, 3), meters
        The root does not move and every bone keeps its direction. A bone of length 0 takes the
        direction of the rest pose. All descendants of a missing joint are NaN.

    Raises
    ------
    InvalidMotionError
        The number of joints differs.
    """
    if positions.shape[1:] != (skeleton.n_joints, 3):
        raise InvalidMotionError(
            f"Positions for this skeleton need shape (n_frames, {skeleton.n_joints}, 3),"
            f" not {positions.shape}."
        )
    lengths = np.linalg.norm(skeleton.offsets, axis=-1)
    result = np.array(positions, dtype=np.float64)
    for joint, parent in enumerate(skeleton.parents[1:], start=1):
        bone = positions[:, joint] - positions[:, parent]
        bone = np.where((bone == 0.0).all(axis=-1)[:, None], skeleton.offsets[joint], bone)
        length = np.linalg.norm(bone, axis=-1, keepdims=True)
        scale = lengths[joint] / np.where(length > 0.0, length, 1.0)
        scale = np.where(np.isfinite(length), scale, np.nan)
        result[:, joint] = result[:, parent] + scale * bone
    return result


def transfer_motion(
    motion: Motion, skeleton: Skeleton, humanoid_map: HumanoidMap | None = None
) -> Motion:
    """Transfer a motion to a skeleton with the same joints and other bone lengths.

    Rotations are unchanged. Root positions are scaled by the leg lengths about the ground
    (height 0) below the first observed position, so that steps scale and feet do not slide
    more.

    Parameters
    ----------
    motion : Motion
    skeleton : Skeleton
        The same joint names and hierarchy.
    humanoid_map : HumanoidMap, optional
        Roles of the leg joints; by default from `find_humanoid_map`. Bodies without legs are
        compared by height.

    Returns
    -------
    Motion
        The motion of `skeleton`, with the frames and gaps of `motion`.

    Raises
    ------
    InvalidMotionError
        The joints differ.
    """
    if not motion.skeleton.same_joints(skeleton):
        raise InvalidMotionError(
            "The two skeletons have different joints; retarget the motion instead."
        )
    humanoid = humanoid_map or find_humanoid_map(motion.skeleton)
    scale = _leg_ratio(motion.skeleton, skeleton, humanoid)
    root_positions = motion.root_positions
    observed = np.isfinite(root_positions).all(axis=-1)
    start = (
        root_positions[observed.argmax()] * (1.0, 1.0, 0.0) if observed.any() else np.zeros(3)
    )
    return Motion(
        skeleton, motion.rotations, start + scale * (root_positions - start), motion.frame_rate
    )


def _leg_ratio(old: Skeleton, new: Skeleton, humanoid: HumanoidMap) -> float:
    """Return the ratio of leg lengths; without legs, of heights; 1 without heights."""
    legs = [
        f"{side}{part}"
        for side in ("left", "right")
        for part in ("UpperLeg", "LowerLeg", "Foot")
    ]
    if humanoid.has(*legs):
        return leg_length(new, humanoid) / leg_length(old, humanoid)
    return new.height / old.height if old.height > 0.0 and new.height > 0.0 else 1.0
