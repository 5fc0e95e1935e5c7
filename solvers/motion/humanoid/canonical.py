"""Rotations as if every rig rested in the same T-pose, so that clips of one rig serve another.

A joint's rotation is measured from its rest pose, and rest poses differ: arms level, lowered or
hanging. Let A_i turn a bone of the canonical T-pose (upright, facing -Y, arms along +-X, legs
along -Z) into joint i's bone in this rig's rest pose. A world rotation W_i from this rig's rest
is W_i A_i from the T-pose, hence a local rotation L_i is A_parent^-1 L_i A_i.
"""

import numpy as np
from numpy.typing import NDArray

from ...rotations import (
    IDENTITY,
    angle_between,
    inverse,
    multiply,
    quaternion_from_matrix,
    quaternion_from_rotation_vector,
    rotate,
    rotation_between,
)
from ..skeletons import Motion, Skeleton
from .palms import with_palms_down
from .roles import HumanoidMap

UP = np.array([0.0, 0.0, 1.0])
FORWARD = np.array([0.0, -1.0, 0.0])
LEFT = np.array([1.0, 0.0, 0.0])

LIMB_BONES = {
    "UpperArm": "LowerArm", "LowerArm": "Hand", "Hand": "MiddleProximal",
    "IndexProximal": "IndexIntermediate", "IndexIntermediate": "IndexDistal",
    "MiddleProximal": "MiddleIntermediate", "MiddleIntermediate": "MiddleDistal",
    "RingProximal": "RingIntermediate", "RingIntermediate": "RingDistal",
    "LittleProximal": "LittleIntermediate", "LittleIntermediate": "LittleDistal",
    "UpperLeg": "LowerLeg", "LowerLeg": "Foot",
}  # fmt: skip
"""Role whose joint begins a bone that the T-pose prescribes, and role at the bone's end."""

SAME_DIRECTION = np.radians(1.0)
"""By so much, feet must point straighter to count as tilted."""

SAME_FACING = np.radians(8.0)
"""By so much, hips and shoulders may be turned aside in a rest pose that faces straight on:
one shoulder rests before the other in measured bodies (4 degrees in HDM05's)."""

STEEPEST_SOLE = np.sin(np.radians(65.0))
"""A foot bone steeper than this does not stand on its sole: the rest pose points its toes."""


def t_pose_alignment(skeleton: Skeleton, humanoid: HumanoidMap) -> NDArray[np.float64]:
    """Return for each joint the world rotation from the canonical T-pose to this rest pose.

    Bones of arms, legs and fingers turn the short way, on top of the turn of the bone above, so
    that a lowered arm keeps the palm it would have when raised. A hand points to its middle
    finger, or to its end site where that is all it has; its palm faces down unless the knuckles
    say otherwise (`with_palms_down`). Feet turn about the vertical
    only, since the height of the ankle differs between rigs that all stand flat on the floor;
    where spread legs have tilted feet (Acclaim), about the axis of the shin.
    Trunk, head and collar bones differ in anatomy rather than in pose: they turn together, by
    whole right angles for rigs whose rest pose lies down, and about the vertical to where the
    lines of hips and shoulders face. Joints without a role turn with the nearest role above.

    Parameters
    ----------
    skeleton : Skeleton
    humanoid : HumanoidMap
        Roles whose joint the skeleton lacks are ignored.

    Returns
    -------
    NDArray, shape (n_joints, 4)
        Unit quaternions w x y z; identity throughout for a rig that rests in the T-pose.
    """
    joints = humanoid.indices(skeleton)
    roles = {joint: role for role, joint in joints.items()}
    rest = skeleton.rest_positions
    trunk = _trunk_alignment(rest, joints)
    alignment = np.tile(trunk, (skeleton.n_joints, 1))
    for joint, parent in enumerate(skeleton.parents):
        side, part = _split(roles.get(joint, ""))
        if parent >= 0:
            alignment[joint] = alignment[parent]
        end = joints.get(side + LIMB_BONES.get(part, ""))
        if end is None and part == "Hand":
            end = _lone_end_site(skeleton, joint)
        if part in LIMB_BONES and end is not None:
            alignment[joint] = _swung(
                alignment[joint], _t_pose_bone(side, part), rest[end] - rest[joint]
            )
    _align_feet(alignment, skeleton, joints, trunk)
    return with_palms_down(alignment, skeleton, joints)


def canonical_rotations(motion: Motion, humanoid: HumanoidMap) -> NDArray[np.float64]:
    """Return local rotations as if the rest pose were the T-pose, (n_frames, n_joints, 4).

    NaN stays NaN. `from_canonical` is the inverse.
    """
    alignment = t_pose_alignment(motion.skeleton, humanoid)
    return multiply(
        multiply(inverse(_above(motion.skeleton, alignment)), motion.rotations), alignment
    )


def from_canonical(
    rotations: NDArray[np.float64], skeleton: Skeleton, humanoid: HumanoidMap
) -> NDArray[np.float64]:
    """Return the local rotations from this skeleton's own rest pose, (..., n_joints, 4)."""
    alignment = t_pose_alignment(skeleton, humanoid)
    return multiply(multiply(_above(skeleton, alignment), rotations), inverse(alignment))


def _above(skeleton: Skeleton, alignment: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the alignment of each joint's parent; identity above the root."""
    return np.concatenate([IDENTITY[None], alignment[list(skeleton.parents[1:])]])


def _trunk_alignment(rest: NDArray[np.float64], joints: dict[str, int]) -> NDArray[np.float64]:
    """Return the turn that fits hips and head by whole right angles, and left-right best."""
    sides = [
        (joints[f"left{part}"], joints[f"right{part}"])
        for part in ("UpperLeg", "UpperArm")
        if f"left{part}" in joints and f"right{part}" in joints
    ]
    top = next((joints[role] for role in ("neck", "head", "chest") if role in joints), None)
    if not sides or top is None or "hips" not in joints:
        return IDENTITY.copy()
    left = np.sum([rest[a] - rest[b] for a, b in sides], axis=0)
    up = rest[top] - rest[joints["hips"]]
    matrix = _nearest_right_angles(left, up)
    turned = quaternion_from_matrix(matrix)
    aside, back, _ = left @ matrix
    yaw = np.arctan2(back, aside)
    if abs(yaw) <= SAME_FACING:
        return turned
    return multiply(turned, quaternion_from_rotation_vector(yaw * UP))


def _nearest_right_angles(
    left: NDArray[np.float64], up: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the signed permutation matrix whose columns are nearest to left, back and up."""
    matrix = np.zeros((3, 3))
    vertical = int(np.abs(up).argmax())
    matrix[vertical, 2] = np.sign(up[vertical]) or 1.0
    lateral = int(np.where(matrix[:, 2] == 0.0, np.abs(left), -1.0).argmax())
    matrix[lateral, 0] = np.sign(left[lateral]) or 1.0
    matrix[:, 1] = np.cross(matrix[:, 2], matrix[:, 0])
    return matrix


def _swung(
    start: NDArray[np.float64], canonical: NDArray[np.float64], bone: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return `start` followed by the smallest turn that brings the canonical bone to `bone`."""
    return multiply(rotation_between(rotate(start, canonical), bone), start)


def _align_feet(
    alignment: NDArray[np.float64],
    skeleton: Skeleton,
    joints: dict[str, int],
    trunk: NDArray[np.float64],
) -> None:
    """Let feet stand level or tilt with their shins: whichever points both more forward."""
    feet, bones = [], []
    for side in ("left", "right"):
        if f"{side}Foot" in joints:
            feet.append(joints[f"{side}Foot"])
            bones.append(_foot_bone(skeleton, feet[-1], joints.get(f"{side}Toes")))
    pairs = list(zip(feet, bones, strict=True))
    level = [_foot_turned(trunk, bone) for _, bone in pairs]
    tilted = [_foot_turned(alignment[foot], bone) for foot, bone in pairs]
    level_aside = sum(float(angle_between(trunk, turn)) for turn in level)
    tilted_aside = sum(
        float(angle_between(alignment[foot], turn))
        for foot, turn in zip(feet, tilted, strict=True)
    )
    best = tilted if tilted_aside < level_aside - SAME_DIRECTION else level
    for foot, turn in zip(feet, best, strict=True):
        alignment[skeleton.subtree(foot)] = turn


def _foot_turned(start: NDArray[np.float64], bone: NDArray[np.float64]) -> NDArray[np.float64]:
    """Turn a foot that points forward so that it points along the bone, sole level."""
    up = rotate(start, UP)
    level = bone - (bone @ up) * up
    stands = np.linalg.norm(bone - level) <= STEEPEST_SOLE * np.linalg.norm(bone)
    return _swung(start, FORWARD, level if stands else bone)


def _lone_end_site(skeleton: Skeleton, joint: int) -> int | None:
    children = skeleton.children[joint]
    return children[0] if len(children) == 1 and skeleton.is_end_site(children[0]) else None


def _t_pose_bone(side: str, part: str) -> NDArray[np.float64]:
    if part.endswith("Leg"):
        return -UP
    return LEFT if side == "left" else -LEFT


def _foot_bone(skeleton: Skeleton, foot: int, toes: int | None) -> NDArray[np.float64]:
    """Return the way from ankle to toes, or to the end site, or zero where there is neither."""
    children = skeleton.children[foot]
    end = toes if toes is not None else next(iter(children), foot)
    return np.asarray(skeleton.rest_positions[end] - skeleton.rest_positions[foot])


def _split(role: str) -> tuple[str, str]:
    """Split "leftUpperLeg" into "left" and "UpperLeg"."""
    for side in ("left", "right"):
        if role.startswith(side):
            return side, role.removeprefix(side)
    return "", role
