"""Give a motion a standing rest pose, if its file has another."""

import numpy as np

from ...arrays import Array, Flags, Integers
from ...rotations import IDENTITY, inverse, multiply, quaternion_from_matrix, rotate
from ..skeletons import MIN_BONE_M, Motion, Skeleton, WorldPoses, forward_kinematics
from .roles import HumanoidMap
from .tables import SIDES

LEG_BONES = tuple(
    (f"{side}{upper}", f"{side}{lower}")
    for side in SIDES
    for upper, lower in (("UpperLeg", "LowerLeg"), ("LowerLeg", "Foot"))
)
FOOT_BONES = tuple((f"{side}Foot", f"{side}Toes") for side in SIDES)
FRAME_ROLES = ("hips", "leftUpperLeg", "rightUpperLeg")
SHOULDERS = ("leftUpperArm", "rightUpperArm")
MIN_SIDE_COSINE = 0.5
"""Cosine between the lines through both shoulders and both hips. It guards the rest poses of
people, 0.9 and more; spines that rest along one axis give -1 to 0.2."""
STANDING_QUANTILE = 0.25
"""Quantile, a fraction, of the heights of ankles up to which a foot stands. Chosen by hand: in
a walk each foot stands for more than half of the time.
`test_the_feet_rest_as_they_stand_though_they_hang_most_of_the_time` fails without it."""
TOPS = ("neck", "head", "chest", "spine")


def with_standing_rest(motion: Motion, humanoid: HumanoidMap) -> Motion:
    """Return the same motion with a standing rest pose, if that of its file is not a person's.

    Files of some data sets have rest poses that no body can take: each bone lies along an axis
    of its joint, so that one leg points down and the other up, or the trunk lies on its side
    above the legs. The axial rotation of a limb relative to the T-pose, and the height of the
    ankles, cannot be read from such a pose. The rest pose is then that of the frame with the
    straightest legs, upright and facing -Y, with the hips at the origin; each foot takes its
    pose from a frame in which it stands. The positions of all joints over time stay the same.

    Parameters
    ----------
    motion : Motion
        Gaps stay gaps in the same joints.
    humanoid : HumanoidMap
        A body without hips, legs or neck keeps its rest pose.
    """
    joints = humanoid.indices(motion.skeleton)
    top = next((joints[role] for role in TOPS if role in joints), None)
    legs, feet = (
        [(joints[a], joints[b]) for a, b in bones if a in joints and b in joints]
        for bones in (LEG_BONES, FOOT_BONES)
    )
    if top is None or not legs or not joints.keys() >= set(FRAME_ROLES):
        return motion
    hips, left, right = (joints[role] for role in FRAME_ROLES)
    rest = motion.skeleton.rest_positions[None]
    is_standing = _smallest_cosine(rest, legs, rest[:, hips] - rest[:, top])[0] > 0.0
    if is_standing and _sides_agree(rest, joints):
        return motion
    poses = forward_kinematics(motion)
    positions = poses.positions
    up = positions[:, top] - positions[:, hips]
    across = positions[:, left] - positions[:, right]
    usable = np.isfinite(poses.rotations).all(axis=(1, 2))
    usable &= np.linalg.norm(np.cross(up, across), axis=1) > MIN_BONE_M**2
    straight = _smallest_cosine(positions, legs, -up)
    usable &= np.isfinite(straight)
    if not usable.any():
        return motion
    chosen = np.full(motion.skeleton.n_joints, np.argmax(np.where(usable, straight, -np.inf)))
    upright = np.stack([_upright_from(up[frame], across[frame]) for frame in chosen])
    # A trunk that is nearer to the vertical than to the ground is above feet that may stand.
    stands = usable & (up[:, 2] > np.linalg.norm(up[:, :2], axis=1))
    for ankle, toes in feet if stands.any() else ():
        below = motion.skeleton.subtree(ankle)
        chosen[below] = frame = _standing_frame(positions, ankle, toes, stands)
        upright[below] = _upright_from(np.array([0.0, 0.0, 1.0]), across[frame])
    return _with_rest(motion, poses, chosen, upright, hips)


def _smallest_cosine(positions: Array, bones: list[tuple[int, int]], direction: Array) -> Array:
    """Return the cosine between a direction and the bone farthest from it, (n_frames,).

    Parameters
    ----------
    positions : shape (n_frames, n_joints, 3), meters
    bones : list of (start, end)
        Without any, the result is 1.
    direction : shape (n_frames, 3)
    """
    smallest = np.ones(len(positions))
    for start, end in bones:
        bone = positions[:, end] - positions[:, start]
        length = np.linalg.norm(bone, axis=1) * np.linalg.norm(direction, axis=1)
        smallest = np.minimum(smallest, (bone * direction).sum(axis=1) / (length + 1e-9))
    return smallest


def _sides_agree(rest: Array, joints: dict[str, int]) -> bool:
    """Return whether the shoulders, if there are two, are about parallel to the hips."""
    shoulders = [(joints[b], joints[a]) for a, b in [SHOULDERS] if a in joints and b in joints]
    across = rest[:, joints["leftUpperLeg"]] - rest[:, joints["rightUpperLeg"]]
    shoulders = [
        (right, left)
        for right, left in shoulders
        if np.linalg.norm(rest[0, left] - rest[0, right]) > MIN_BONE_M
    ]
    return bool(_smallest_cosine(rest, shoulders, across)[0] > MIN_SIDE_COSINE)


def _standing_frame(positions: Array, ankle: int, toes: int, usable: Flags) -> int:
    """Return a frame in which a foot stands, flat on the ground.

    Ankles are lowest where the foot stands, or just before it lifts; the median slope there is
    that of a standing foot, and not of one with raised toes.
    """
    bone = positions[:, toes] - positions[:, ankle]
    slope = np.arctan2(bone[:, 2].copy(), np.linalg.norm(bone[:, :2], axis=1))
    height = np.where(usable, positions[:, ankle, 2], np.inf)
    low = height <= np.quantile(height[usable], STANDING_QUANTILE)
    return int(np.argmin(np.where(low, np.abs(slope - np.median(slope[low])), np.inf)))


def _upright_from(up: Array, left: Array) -> Array:
    """Return the rotation from a body, given by two directions, to one that faces -Y."""
    up = up / np.linalg.norm(up)
    left = left - (left @ up) * up
    left = left / np.linalg.norm(left)
    return quaternion_from_matrix(np.stack([left, np.cross(up, left), up]))


def _with_rest(
    motion: Motion, poses: WorldPoses, chosen: Integers, upright: Array, hips: int
) -> Motion:
    """Return the motion with another rest pose.

    Parameters
    ----------
    motion : Motion
    poses : WorldPoses
    chosen : shape (n_joints,), frame whose pose each joint takes
    upright : shape (n_joints, 4), rotation that makes the body of that frame stand
    hips : joint that is at the origin then
    """
    skeleton = motion.skeleton
    # From the old rest pose to the new one, in the world.
    rest_rotations = multiply(upright, poses.rotations[chosen, np.arange(skeleton.n_joints)])
    parent_rotations = np.concatenate([
        IDENTITY[None],
        rest_rotations[list(skeleton.parents[1:])],
    ])
    rotations = multiply(multiply(parent_rotations, motion.rotations), inverse(rest_rotations))
    offsets = rotate(parent_rotations, skeleton.offsets)
    offsets[0] = 0.0
    standing = Skeleton(skeleton.names, skeleton.parents, offsets)
    offsets[0] = -standing.rest_positions[hips]
    return Motion(
        Skeleton(skeleton.names, skeleton.parents, offsets),
        rotations,
        motion.root_positions,
        motion.frame_rate,
    )
