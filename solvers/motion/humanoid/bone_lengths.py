"""Transfer a motion to a skeleton with the same joints and other bone lengths."""

import numpy as np

from ...errors import InvalidMotionError
from ..skeletons import Motion, Skeleton
from .foot_contacts import leg_length
from .roles import HumanoidMap, find_humanoid_map
from .tables import SIDES


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
    legs = [f"{side}{part}" for side in SIDES for part in ("UpperLeg", "LowerLeg", "Foot")]
    if humanoid.has(*legs):
        return leg_length(new, humanoid) / leg_length(old, humanoid)
    return new.height / old.height if old.height > 0.0 and new.height > 0.0 else 1.0
