"""Refuse humanoid maps that do not describe a body."""

from itertools import pairwise

import numpy as np

from ..arrays import Array
from ..errors import InvalidMotionError
from ..motion import Motion, Skeleton, forward_kinematics
from ..motion.humanoid import SIDES
from ..rotations import angle_between

Joints = dict[str, int]
MIN_BACKWARD_ANGLE_RAD = np.radians(135.0)
"""Angle in radians between feet and hips from which the feet point backward. By definition:
halfway between square and opposite."""
MIN_KNEE_BEND = 0.08
"""Distance of the knee from the line between hip and ankle, as a fraction of the leg, from
which it shows where it bends. Chosen by hand: 37 degrees of flexion, far above noise."""
MAX_KNEES_FORWARD = 0.1
"""Fraction of bent knees in front of that line, below which knees bend backward. Measured: 1.0
in people, 0.0 where left and right are swapped."""
MIN_BENT_FRAMES = 10
"""Frames with a bent knee that show its direction; fewer may be faults of a sensor."""
MAX_SAMPLED_FRAMES = 500
LIMBS = {
    "Leg": ("UpperLeg", "LowerLeg", "Foot"),
    "Arm": ("UpperArm", "LowerArm", "Hand"),
}


def check_roles(skeleton: Skeleton, joints: Joints, whose: str) -> None:
    """Refuse detached or unordered limbs, a head below the hips, and inconsistent sides.

    Raises
    ------
    InvalidMotionError
        The message names the joints, their roles and, where needed, `whose` skeleton it is.
    """
    for side in SIDES:
        for parts in LIMBS.values():
            _check_limb(skeleton, joints, [f"{side}{part}" for part in parts])
    _check_head(skeleton, joints, whose)
    _check_sides(skeleton, joints, whose)


def _check_limb(skeleton: Skeleton, joints: Joints, roles: list[str]) -> None:
    root, hips = roles[0], joints["hips"]
    if root in joints and hips not in skeleton.ancestors(joints[root]):
        raise InvalidMotionError(
            f"{skeleton.names[joints[root]]} ({root}) is not a descendant of"
            f" {skeleton.names[hips]} (hips) and would not follow it. Map bones of one tree,"
            " such as a rig's controls."
        )
    present = [role for role in roles if role in joints]
    for upper, lower in pairwise(present):
        if joints[upper] not in skeleton.ancestors(joints[lower]):
            raise InvalidMotionError(
                f"{skeleton.names[joints[lower]]} ({lower}) is not a descendant of"
                f" {skeleton.names[joints[upper]]} ({upper}) and would not follow it. Map one"
                " chain of bones, from the body outwards, or leave this limb without roles."
            )


def _check_head(skeleton: Skeleton, joints: Joints, whose: str) -> None:
    """Refuse a head or neck that is an ancestor of the hips, or rests below them."""
    rest, hips = skeleton.rest_positions, joints["hips"]
    for role in ("neck", "head"):
        if joints.get(role) in skeleton.ancestors(hips):
            raise InvalidMotionError(
                f"{skeleton.names[hips]} (hips) is a descendant of"
                f" {skeleton.names[joints[role]]} ({role}) in the {whose}. Choose"
                " other joints in the map."
            )
    feet = [joints[f"{side}Foot"] for side in SIDES if f"{side}Foot" in joints]
    if len(feet) < len(SIDES):
        return
    up = rest[hips] - rest[feet].mean(axis=0)
    for role in ("neck", "head"):
        if role in joints and (rest[joints[role]] - rest[hips]) @ up < 0.0:
            raise InvalidMotionError(
                f"{skeleton.names[joints[role]]} ({role}) is below {skeleton.names[hips]}"
                f" (hips) where the {whose} rests. Choose other joints in the map."
            )


def _check_sides(skeleton: Skeleton, joints: Joints, whose: str) -> None:
    """Refuse a left arm and a left leg on different sides of the body."""
    rest = skeleton.rest_positions
    legs, arms = (_lateral_vector(rest, joints, parts[0]) for parts in LIMBS.values())
    if legs @ arms < 0.0:
        raise InvalidMotionError(
            f"Left arm and left leg of the {whose} are on different sides of the body."
            " Swap left and right of the arms, or of the legs, in the map."
        )


def _lateral_vector(rest: Array, joints: Joints, part: str) -> Array:
    """Return the vector from the right to the left limb, meters; zero if one is missing.

    It is measured at the start of the limbs, since hands and feet may be crossed.
    """
    left, right = (joints.get(f"{side}{part}") for side in SIDES)
    if left is None or right is None:
        return np.zeros(3)
    return np.asarray(rest[left] - rest[right])


def check_feet(alignment: Array, joints: Joints, whose: str) -> None:
    """Refuse a body whose feet both point backwards, as in mirrored Kinect recordings.

    The alignment, (n_joints, 4), rotates each joint of the rest pose to the T-pose.
    """
    feet = [joints[f"{side}Foot"] for side in SIDES if f"{side}Foot" in joints]
    angles = angle_between(alignment[feet], alignment[joints["hips"]])
    if len(feet) == len(SIDES) and (angles > MIN_BACKWARD_ANGLE_RAD).all():
        raise InvalidMotionError(
            f"The feet of the {whose} point backwards in the rest pose. Swap left and"
            " right in the map, as for a mirrored recording, or give the toes their role."
        )


def knees_bend_backward(motion: Motion, joints: Joints) -> bool:
    """Whether both knees bend backward, as where left and right are the viewer's.

    Without toes the rest pose does not show where a body faces: only its sides do.
    """
    thighs = [joints.get(f"{side}UpperLeg") for side in SIDES]
    top = next((joints[role] for role in ("neck", "head", "chest") if role in joints), None)
    if None in thighs or top is None:
        return False
    sampled = motion.rotations[:: -(-motion.n_frames // MAX_SAMPLED_FRAMES)]
    still = Motion(motion.skeleton, sampled, np.zeros((len(sampled), 3)), motion.frame_rate)
    positions = forward_kinematics(still).positions
    left, right = (positions[:, thigh] for thigh in thighs)
    forward = np.cross(left - right, positions[:, top] - positions[:, joints["hips"]])
    bends = [_knee_bends(positions, joints, side, forward) for side in SIDES]
    return all(
        len(each) >= MIN_BENT_FRAMES and bool((each > 0.0).mean() < MAX_KNEES_FORWARD)
        for each in bends
    )


def _knee_bends(positions: Array, joints: Joints, side: str, forward: Array) -> Array:
    """Return how far forward each clearly bent knee is, as a fraction of the leg."""
    roles = [f"{side}{part}" for part in LIMBS["Leg"]]
    if any(role not in joints for role in roles):
        return np.empty(0)
    hip, knee, ankle = (positions[:, joints[role]] for role in roles)
    leg = np.linalg.norm(knee - hip, axis=-1) + np.linalg.norm(ankle - knee, axis=-1)
    along = (ankle - hip) / np.maximum(np.linalg.norm(ankle - hip, axis=-1), 1e-9)[:, None]
    aside = knee - hip
    aside = aside - (aside * along).sum(axis=-1, keepdims=True) * along
    length = np.linalg.norm(forward, axis=-1)
    ahead = (aside * forward).sum(axis=-1) / np.maximum(length * leg, 1e-9)
    is_bent = np.linalg.norm(aside, axis=-1) > MIN_KNEE_BEND * leg
    return np.asarray(ahead[is_bent & np.isfinite(ahead)])
