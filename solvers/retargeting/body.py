"""The humanoid part of a skeleton, prepared for retargeting."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..errors import InvalidMotionError
from ..motion import HumanoidMap, Motion, Skeleton, t_pose_alignment
from ..motion.humanoid import prolongs_shin
from .map_checks import check_feet, check_roles

SOURCE = "source's skeleton"
TARGET = "target's skeleton"
MOTION = "motion's skeleton"
FEET = ("leftFoot", "rightFoot", "leftToes", "rightToes")


@dataclass(frozen=True, eq=False)
class HumanoidBody:
    """Joints with a role, their ancestors, and the ends of feet and toes.

    Attributes
    ----------
    skeleton : Skeleton
        Of these joints only.
    joint_indices : tuple of int
        Their indices in the complete skeleton.
    joints : dict of role to index in `skeleton`
    alignment : shape (n_joints, 4)
        World rotation from the canonical T-pose to the rest pose, of each joint.
    """

    skeleton: Skeleton
    joint_indices: tuple[int, ...]
    joints: dict[str, int]
    alignment: Array

    @property
    def rest(self) -> Array:
        """Joint centers in the rest pose, shape (n_joints, 3), meters."""
        return self.skeleton.rest_positions

    def limb(self, side: str, part: str) -> tuple[int, int, int] | None:
        """Return upper joint, hinge and end of an "Arm" or "Leg"; None if incomplete."""
        end = "Hand" if part == "Arm" else "Foot"
        roles = [f"{side}Upper{part}", f"{side}Lower{part}", f"{side}{end}"]
        if not all(role in self.joints for role in roles):
            return None
        upper, lower, last = (self.joints[role] for role in roles)
        skeleton = self.skeleton
        is_chain = upper in skeleton.ancestors(lower) and lower in skeleton.ancestors(last)
        limb = (upper, lower, last)
        usable = is_chain and skeleton.parents[upper] >= 0 and self.limb_length(limb) > 0.0
        return limb if usable else None

    def limb_length(self, limb: tuple[int, int, int]) -> float:
        """Return the length of a limb from upper joint over hinge to end, meters."""
        return float(np.linalg.norm(np.diff(self.rest[list(limb)], axis=0), axis=-1).sum())

    def hip_joints(self) -> list[int]:
        """Return both upper legs, or the hips if a leg has no role."""
        roles = ("leftUpperLeg", "rightUpperLeg")
        valid = [self.joints[role] for role in roles if role in self.joints]
        return valid if len(valid) == len(roles) else [self.joints["hips"]]


def find_body(skeleton: Skeleton, humanoid: HumanoidMap, whose: str) -> HumanoidBody:
    """Return the body of a skeleton.

    Raises
    ------
    InvalidMotionError
        The hips have no joint, a limb is not a chain below them, the head rests below, left
        and right of arms and legs differ, or the feet point backwards. The message names
        `whose` skeleton it is, such as SOURCE.
    """
    hips_of(skeleton, humanoid, whose)
    joints = humanoid.indices(skeleton)
    check_roles(skeleton, joints, whose)
    alignment = t_pose_alignment(skeleton, humanoid)
    check_feet(alignment, joints, whose)
    ancestors = {up for joint in joints.values() for up in skeleton.ancestors(joint)}
    feet = [joints[role] for role in FEET if role in joints]
    feet = [foot for foot in feet if not prolongs_shin(skeleton, foot)]
    ends = {child for foot in feet for child in skeleton.children[foot][:1]}
    joint_indices = tuple(sorted({*joints.values(), *ancestors, *ends, 0}))
    new_index = {joint: index for index, joint in enumerate(joint_indices)}
    return HumanoidBody(
        skeleton.select(joint_indices),
        joint_indices,
        {role: new_index[joint] for role, joint in joints.items()},
        alignment[list(joint_indices)],
    )


def hips_of(skeleton: Skeleton, humanoid: HumanoidMap, whose: str) -> int:
    """Return the joint with the role hips; see `find_body`."""
    if (hips := humanoid.indices(skeleton).get("hips")) is None:
        raise InvalidMotionError(
            f"No joint of the {whose} has the humanoid role hips. Choose one in the map."
        )
    return hips


def without_gaps(motion: Motion, body: HumanoidBody) -> tuple[Motion, NDArray[np.bool_]]:
    """Return the body's motion with gaps filled by the last pose, and a mask of the gaps.

    Frames before the first observed pose get that pose; a joint without one gets its rest pose.

    Returns
    -------
    Motion, and bool array of shape (n_frames, n_joints): missing rotations
    """
    rotations = motion.rotations[:, list(body.joint_indices)]
    missing = ~np.isfinite(rotations).all(axis=-1)
    for joint in np.flatnonzero(missing.any(axis=0)):
        rotations[:, joint] = hold_gaps(rotations[:, joint], (1.0, 0.0, 0.0, 0.0))
    root_positions = hold_gaps(motion.root_positions, body.rest[0])
    return Motion(body.skeleton, rotations, root_positions, motion.frame_rate), missing


def hold_gaps(values: Array, default: Array | tuple[float, ...]) -> Array:
    """Return values, shape (n_frames, n), with gaps filled by the last valid value.

    Frames before the first valid value get that value; without any, all get `default`.
    """
    valid = np.isfinite(values).all(axis=-1)
    if not valid.any():
        return np.tile(np.asarray(default, dtype=np.float64), (len(values), 1))
    first = int(valid.argmax())
    last = np.maximum.accumulate(np.where(valid, np.arange(len(values)), first))
    return np.asarray(values[last])
