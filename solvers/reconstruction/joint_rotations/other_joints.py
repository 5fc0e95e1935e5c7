"""Joints that postures are not made of move with the nearest one that they are made of."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...motion import joint_parents
from ...motion.humanoid import N_JOINTS, PARENTS, POSTURE_JOINTS, joints_of_names
from ...rotations import IDENTITY, best_turns, inverse, multiply, rotate, rotation_between

Array = NDArray[np.float64]

TRUNK = {
    "chest": (0.0, 0.0, 1.0),
    "leftUpperArm": (0.5, 0.0, 1.0),
    "rightUpperArm": (-0.5, 0.0, 1.0),
    "leftUpperLeg": (0.5, 0.0, 0.0),
    "rightUpperLeg": (-0.5, 0.0, 0.0),
}
"""Where these are about the hips of a body that stands and faces -Y; only ways count."""


def find_anchors(names: Sequence[str]) -> NDArray[np.intp]:
    """Return which posture joint each tracked joint moves with, shape (n_joints,).

    Its own, or that of the nearest joint in the tree, those above first.
    """
    own = {place: POSTURE_JOINTS.index(role) for role, place in joints_of_names(names).items()}
    parents = joint_parents(names)
    ways = [
        {joint} | {child for child, above in enumerate(parents) if above == joint}
        for joint in range(len(names))
    ]
    found = []
    for joint in range(len(names)):
        reached, front = {joint}, [joint]
        while front and not any(each in own for each in front):
            above = [parents[each] for each in front if parents[each] >= 0]
            below = [child for each in front for child in sorted(ways[each])]
            front = [each for each in dict.fromkeys(above + below) if each not in reached]
            reached.update(front)
        found.append(next((own[each] for each in front if each in own), 0))
    return np.array(found, dtype=np.intp)


def positions_from_postures(
    names: Sequence[str], seen: Array, trust: Array, before: Array, after: Array
) -> Array:
    """Return where all tracked joints are when those of postures were moved.

    A joint of its own keeps its place about its anchor, which turns the short way as the bone
    that leads to the anchor does; where it was not trusted, that is its usual place. The usual
    place is told in axes that the bone carries along from where it mostly points on the body,
    so that they turn round quickly only where it points the very other way.

    Parameters
    ----------
    names : sequence of str
    seen : shape (n_frames, n_joints, 3), metres
        NaN: not seen.
    trust : shape (n_frames, n_joints)
    before, after : shape (n_frames, 20, 3), metres
        Joints of postures as they were seen, and as they are now.
    """
    own = {place: POSTURE_JOINTS.index(role) for role, place in joints_of_names(names).items()}
    result = np.empty_like(seen)
    bones_before, bones_after = _bones(before), _bones(after)
    trunk = _trunk_rotations(after)
    for joint, anchor in enumerate(find_anchors(names)):
        if joint in own:
            result[:, joint] = after[:, own[joint]]
            continue
        bones = bones_before[:, anchor], bones_after[:, anchor]
        axes_before, axes_after = (_bone_axes(trunk, bone, bones[1]) for bone in bones)
        way = seen[:, joint] - before[:, anchor]
        turned = rotate(_swings(*bones), way)
        told = np.isfinite(turned).all(axis=-1)
        weight = np.where(told, trust[:, joint], 0.0)
        sure = told & (weight >= 0.5 * weight.max(initial=0.0))
        local = rotate(inverse(axes_before[sure]), way[sure])
        usual = np.median(local, axis=0) if sure.any() else np.zeros(3)
        blend = weight[:, None] * np.where(told[:, None], turned, 0.0)
        blend += (1.0 - weight)[:, None] * rotate(axes_after, usual)
        result[:, joint] = after[:, anchor] + blend
    return result


def _bones(postures: Array) -> Array:
    """Return the bone that leads to each joint, shape (n_frames, 20, 3); to hips the spine."""
    ends = [joint or 1 for joint in range(N_JOINTS)]
    return np.asarray(postures[:, ends] - postures[:, [PARENTS[end] for end in ends]])


def _trunk_rotations(postures: Array) -> Array:
    """Return how the trunk is turned against one that stands and faces -Y, (n_frames, 4)."""
    seen = postures[:, [POSTURE_JOINTS.index(role) for role in TRUNK]] - postures[:, :1]
    turns = best_turns(np.array(list(TRUNK.values())), seen)
    return np.where(np.isfinite(turns), turns, IDENTITY)


def _bone_axes(trunk: Array, bones: Array, all_bones: Array) -> Array:
    """Return the trunk's axes, turned the short way to a bone from its usual direction."""
    known = np.isfinite(all_bones).all(axis=-1)
    local = rotate(inverse(trunk[known]), all_bones[known])
    usual = local.mean(axis=0) if known.any() else np.zeros(3)
    return multiply(_swings(rotate(trunk, usual), bones), trunk)


def _swings(start: Array, stop: Array) -> Array:
    """Return the short turns between ways, shape (n_frames, 4); NaN where one is not known."""
    told = (np.isfinite(start) & np.isfinite(stop)).all(axis=-1, keepdims=True)
    turns = rotation_between(np.where(told, start, 1.0), np.where(told, stop, 1.0))
    return np.where(told, turns, np.nan)
