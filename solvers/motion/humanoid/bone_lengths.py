"""Give a body the bone lengths of another, and its motion to that body."""

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ..skeletons import Motion, Skeleton
from .contacts import leg_length
from .roles import HumanoidMap, find_humanoid_map


def fit_bone_lengths(positions: NDArray[np.float64], skeleton: Skeleton) -> NDArray[np.float64]:
    """Move joints along their bones until every bone is as long as in the skeleton.

    Parameters
    ----------
    positions : shape (n_frames, n_joints, 3), metres
        Joints of any body with this skeleton's tree; NaN where not observed.
    skeleton : Skeleton

    Returns
    -------
    NDArray, shape (n_frames, n_joints, 3), metres
        The root stays where it is and every bone keeps its direction. A bone of no length has
        none and takes that of the rest pose. Below a joint that is not observed, all is NaN.

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
        present = np.linalg.norm(bone, axis=-1, keepdims=True)
        scale = lengths[joint] / np.where(present > 0.0, present, 1.0)
        scale = np.where(np.isfinite(present), scale, np.nan)
        result[:, joint] = result[:, parent] + scale * bone
    return result


def transfer_motion(
    motion: Motion, skeleton: Skeleton, humanoid_map: HumanoidMap | None = None
) -> Motion:
    """Let a body of other lengths, with the same joints, make the same motion.

    Rotations stay. Root positions grow with the legs, from the ground (height 0) under the
    first place seen, so that longer legs make longer steps and no foot slides more than before.

    Parameters
    ----------
    motion : Motion
    skeleton : Skeleton
        The same names in the same tree.
    humanoid_map : HumanoidMap, optional
        Says where the legs are; found by `find_humanoid_map` where it is not given. Bodies
        without legs are compared by height.

    Returns
    -------
    Motion
        Of `skeleton`, with the frames and gaps of `motion`.

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
    growth = _growth(motion.skeleton, skeleton, humanoid)
    places = motion.root_positions
    seen = np.isfinite(places).all(axis=-1)
    start = places[seen.argmax()] * (1.0, 1.0, 0.0) if seen.any() else np.zeros(3)
    return Motion(
        skeleton, motion.rotations, start + growth * (places - start), motion.frame_rate
    )


def _growth(old: Skeleton, new: Skeleton, humanoid: HumanoidMap) -> float:
    """Return the ratio of leg lengths; of heights for what has no legs; 1 for what has none."""
    legs = [
        f"{side}{part}"
        for side in ("left", "right")
        for part in ("UpperLeg", "LowerLeg", "Foot")
    ]
    if humanoid.has(*legs):
        return leg_length(new, humanoid) / leg_length(old, humanoid)
    return new.height / old.height if old.height > 0.0 and new.height > 0.0 else 1.0
