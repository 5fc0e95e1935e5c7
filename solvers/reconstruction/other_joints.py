"""Joints that postures are not made of move with the nearest one that they are made of."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..motion import joint_parents
from ..motion.rotations import inverse, rotate, rotation_between
from .posture_joints import N_JOINTS, PARENTS, POSTURE_JOINTS, joints_of_names

Array = NDArray[np.float64]

DOWN = np.array([0.0, 0.0, -1.0])


def anchors(names: Sequence[str]) -> NDArray[np.intp]:
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


def all_joints(
    names: Sequence[str], seen: Array, trust: Array, before: Array, after: Array
) -> Array:
    """Return where all tracked joints are when those of postures were moved.

    A joint of its own keeps its place about its anchor, which turns as the bone that leads to
    the anchor does; where it was not trusted, that is its usual place.

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
    turn_before, turn_after = _bone_turns(before), _bone_turns(after)
    for joint, anchor in enumerate(anchors(names)):
        if joint in own:
            result[:, joint] = after[:, own[joint]]
            continue
        way = rotate(inverse(turn_before[:, anchor]), seen[:, joint] - before[:, anchor])
        told = np.isfinite(way).all(axis=-1)
        weight = np.where(told, trust[:, joint], 0.0)
        sure = weight >= 0.5 * weight.max(initial=0.0)
        usual = np.median(way[told & sure], axis=0) if (told & sure).any() else np.zeros(3)
        blend = weight[:, None] * np.where(told[:, None], way, 0.0)
        blend += (1.0 - weight)[:, None] * usual
        result[:, joint] = after[:, anchor] + rotate(turn_after[:, anchor], blend)
    return result


def _bone_turns(postures: Array) -> Array:
    """Turns from straight down to the bone that leads to each joint, (n_frames, 20, 4)."""
    turns = np.empty((*postures.shape[:2], 4))
    for joint in range(N_JOINTS):
        end = joint or 1  # the hips turn as the bone above them
        bone = postures[:, end] - postures[:, PARENTS[end]]
        told = np.isfinite(bone).all(axis=-1, keepdims=True)
        down = np.broadcast_to(DOWN, bone.shape)
        turns[:, joint] = np.where(
            told, rotation_between(down, np.where(told, bone, DOWN)), np.nan
        )
    return turns
