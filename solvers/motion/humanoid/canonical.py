"""Express rotations relative to a common T-pose, so that clips of one rig fit another.

A joint's rotation is relative to its rest pose, and rest poses differ: arms level, lowered or
hanging. Let A_i rotate a bone of the canonical T-pose (upright, facing -Y, arms along +-X, legs
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
from .tables import SIDES

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
"""Roles at the start and the end of each bone whose direction the T-pose defines."""

MIN_TILT_GAIN_RAD = np.radians(1.0)
"""Feet are tilted if that makes them point straighter by more than this. Chosen by hand on the
rigs of `tests/solvers/motion`."""

MAX_STRAIGHT_YAW_RAD = np.radians(8.0)
"""Yaw of hips and shoulders up to which a rest pose faces straight ahead: measured bodies have
one shoulder in front of the other (4 degrees in HDM05). Chosen by hand on the rigs of
`tests/solvers/motion`."""

MAX_FOOT_FRACTION = 0.75
"""Length of a foot relative to the shin, above which an end site in line with the shin is none.
It guards pointed feet: those of people are 0.3 to 0.5 of the shin, invented tails 1."""
MIN_PROLONGED_COSINE = np.cos(np.radians(10.0))
"""Cosine of the angle between shin and end site up to which they are in line. It guards
rounding: invented tails are exactly in line."""

MAX_SOLE_SLOPE_SINE = np.sin(np.radians(65.0))
"""Slope of a foot bone above which the rest pose has pointed toes, not a flat sole. Chosen by
hand on the rigs of `tests/solvers/motion`."""


def t_pose_alignment(skeleton: Skeleton, humanoid: HumanoidMap) -> NDArray[np.float64]:
    """Return for each joint the world rotation from the canonical T-pose to this rest pose.

    Bones of arms, legs and fingers get the shortest rotation after that of their parent, so
    that the palm of a lowered arm is that of the raised arm. A hand points to its middle
    finger, or to its only end site; its palm faces down unless the knuckles differ
    (`with_palms_down`). Feet rotate about the vertical only, since the height of the ankle
    differs between rigs with flat feet; tilted feet of spread legs (Acclaim) rotate about the
    axis of the shin. Trunk, head and collar bones differ in anatomy, not in pose: they rotate
    together, by right angles for rigs that rest lying down, and about the vertical to the
    facing direction of hips and shoulders. Joints without a role follow the nearest ancestor
    with one.

    Parameters
    ----------
    skeleton : Skeleton
    humanoid : HumanoidMap
        Roles whose joint is missing are ignored.

    Returns
    -------
    NDArray, shape (n_joints, 4)
        Unit quaternions w x y z; identity for a rig that rests in the T-pose.
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
            end = _only_end_site(skeleton, joint)
        if part in LIMB_BONES and end is not None:
            alignment[joint] = _swing_bone(
                alignment[joint], _t_pose_bone(side, part), rest[end] - rest[joint]
            )
    _align_feet(alignment, skeleton, joints, trunk)
    return with_palms_down(alignment, skeleton, joints)


def canonical_rotations(motion: Motion, humanoid: HumanoidMap) -> NDArray[np.float64]:
    """Return local rotations relative to the T-pose, shape (n_frames, n_joints, 4).

    NaN stays NaN. `from_canonical` is the inverse.
    """
    alignment = t_pose_alignment(motion.skeleton, humanoid)
    return multiply(
        multiply(inverse(_parent_alignment(motion.skeleton, alignment)), motion.rotations),
        alignment,
    )


def from_canonical(
    rotations: NDArray[np.float64], skeleton: Skeleton, humanoid: HumanoidMap
) -> NDArray[np.float64]:
    """Return local rotations relative to the skeleton's rest pose, shape (..., n_joints, 4)."""
    alignment = t_pose_alignment(skeleton, humanoid)
    return multiply(
        multiply(_parent_alignment(skeleton, alignment), rotations), inverse(alignment)
    )


def _parent_alignment(
    skeleton: Skeleton, alignment: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the alignment of each joint's parent; identity above the root."""
    return np.concatenate([IDENTITY[None], alignment[list(skeleton.parents[1:])]])


def _trunk_alignment(rest: NDArray[np.float64], joints: dict[str, int]) -> NDArray[np.float64]:
    """Return the rotation of the trunk: right angles, and a yaw from hips and shoulders."""
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
    matrix = _nearest_permutation(left, up)
    aligned = quaternion_from_matrix(matrix)
    lateral_component, back, _ = left @ matrix
    yaw = np.arctan2(back, lateral_component)
    if abs(yaw) <= MAX_STRAIGHT_YAW_RAD:
        return aligned
    return multiply(aligned, quaternion_from_rotation_vector(yaw * UP))


def _nearest_permutation(
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


def _swing_bone(
    start: NDArray[np.float64], canonical: NDArray[np.float64], bone: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return `start` followed by the shortest rotation of the canonical bone onto `bone`."""
    return multiply(rotation_between(rotate(start, canonical), bone), start)


def _align_feet(
    alignment: NDArray[np.float64],
    skeleton: Skeleton,
    joints: dict[str, int],
    trunk: NDArray[np.float64],
) -> None:
    """Align the feet level or tilted with the shins, whichever points both more forward."""
    feet, bones = [], []
    for side in SIDES:
        if f"{side}Foot" in joints:
            feet.append(joints[f"{side}Foot"])
            bones.append(_foot_bone(skeleton, feet[-1], joints.get(f"{side}Toes")))
    pairs = list(zip(feet, bones, strict=True))
    level = [_foot_alignment(trunk, bone) for _, bone in pairs]
    tilted = [_foot_alignment(alignment[foot], bone) for foot, bone in pairs]
    level_angle = sum(float(angle_between(trunk, rotation)) for rotation in level)
    tilted_angle = sum(
        float(angle_between(alignment[foot], rotation))
        for foot, rotation in zip(feet, tilted, strict=True)
    )
    best = tilted if tilted_angle < level_angle - MIN_TILT_GAIN_RAD else level
    for foot, rotation in zip(feet, best, strict=True):
        alignment[skeleton.subtree(foot)] = rotation


def _foot_alignment(
    start: NDArray[np.float64], bone: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the alignment of a foot along its bone, with a level sole."""
    up = rotate(start, UP)
    level = bone - (bone @ up) * up
    is_flat = np.linalg.norm(bone - level) <= MAX_SOLE_SLOPE_SINE * np.linalg.norm(bone)
    return _swing_bone(start, FORWARD, level if is_flat else bone)


def _only_end_site(skeleton: Skeleton, joint: int) -> int | None:
    children = skeleton.children[joint]
    return children[0] if len(children) == 1 and skeleton.is_end_site(children[0]) else None


def _t_pose_bone(side: str, part: str) -> NDArray[np.float64]:
    if part.endswith("Leg"):
        return -UP
    return LEFT if side == "left" else -LEFT


def _foot_bone(skeleton: Skeleton, foot: int, toes: int | None) -> NDArray[np.float64]:
    """Return the vector from ankle to toes, or to the end site; zero without either."""
    end = end_of_foot(skeleton, foot, toes)
    return np.asarray(skeleton.rest_positions[end] - skeleton.rest_positions[foot])


def end_of_foot(skeleton: Skeleton, foot: int, toes: int | None) -> int:
    """Return the joint of the toes, otherwise the farthest one below the ankle, or the ankle.

    The next joint may be at the sole, straight below the ankle, and show no direction. An end
    that only prolongs the shin is not a foot (`prolongs_shin`).
    """
    if toes is not None:
        return toes
    if prolongs_shin(skeleton, foot):
        return foot
    away = np.linalg.norm(skeleton.rest_positions - skeleton.rest_positions[foot], axis=1)
    return max(skeleton.subtree(foot), key=lambda joint: float(away[joint]))


def ball_of_foot(skeleton: Skeleton, foot: int) -> int:
    """Return the joint below an ankle without toes, or the ankle if there is none."""
    return foot if prolongs_shin(skeleton, foot) else (*skeleton.children[foot], foot)[0]


def prolongs_shin(skeleton: Skeleton, foot: int) -> bool:
    """Return whether all that is below an ankle is an end site that repeats the shin.

    Importers of glTF give the last bone of a chain a tail: the direction and the length of the
    bone above it.
    """
    end = _only_end_site(skeleton, foot)
    if end is None:
        return False
    tail, shin = skeleton.offsets[end], skeleton.offsets[foot]
    lengths = np.linalg.norm(tail), np.linalg.norm(shin)
    return bool(
        lengths[0] > MAX_FOOT_FRACTION * lengths[1]
        and tail @ shin > MIN_PROLONGED_COSINE * lengths[0] * lengths[1]
    )


def _split(role: str) -> tuple[str, str]:
    """Split "leftUpperLeg" into "left" and "UpperLeg"."""
    for side in SIDES:
        if role.startswith(side):
            return side, role.removeprefix(side)
    return "", role
