"""Move the tracked joints that are not posture joints along with the nearest posture joint."""

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...motion import joint_parents
from ...motion.humanoid import N_JOINTS, PARENTS, POSTURE_JOINTS, posture_joint_indices
from ...rotations import IDENTITY, fit_rotations, inverse, multiply, rotate, rotation_between

TRUNK = {
    "chest": (0.0, 0.0, 1.0),
    "leftUpperArm": (0.5, 0.0, 1.0),
    "rightUpperArm": (-0.5, 0.0, 1.0),
    "leftUpperLeg": (0.5, 0.0, 0.0),
    "rightUpperLeg": (-0.5, 0.0, 0.0),
}
"""Positions relative to the hips of a body that stands and faces -Y; only directions matter."""


def find_anchors(names: Sequence[str]) -> NDArray[np.intp]:
    """Return the posture joint that each tracked joint moves with, shape (n_joints,).

    A posture joint is its own anchor. Others use the nearest one in the tree, ancestors first.
    """
    return _anchors(tuple(names))


@lru_cache(maxsize=16)
def _anchors(names: tuple[str, ...]) -> NDArray[np.intp]:
    """Find the anchors once for each sensor: a live take needs them in every frame."""
    posture_joints = _posture_joints(names)
    parents = joint_parents(names)
    connected = [
        {joint} | {child for child, above in enumerate(parents) if above == joint}
        for joint in range(len(names))
    ]
    anchors = []
    for joint in range(len(names)):
        reached, frontier = {joint}, [joint]
        while frontier and not any(each in posture_joints for each in frontier):
            above = [parents[each] for each in frontier if parents[each] >= 0]
            below = [child for each in frontier for child in sorted(connected[each])]
            frontier = [each for each in dict.fromkeys(above + below) if each not in reached]
            reached.update(frontier)
        anchors.append(
            next((posture_joints[each] for each in frontier if each in posture_joints), 0)
        )
    found = np.array(anchors, dtype=np.intp)
    found.flags.writeable = False
    return found


class JointOffsets(NamedTuple):
    """Where the joints of an actor are that are not posture joints.

    Attributes
    ----------
    bones : shape (n_joints, 3)
        Mean direction of the bone that leads to each joint's anchor, in axes of the trunk.
    offsets : shape (n_joints, 3), meters
        Median offset of each joint from its anchor, in axes of that bone.
    """

    bones: Array
    offsets: Array


def positions_from_postures(
    names: Sequence[str],
    tracked: Array,
    reliability: Array,
    before: Array,
    after: Array,
    offsets: JointOffsets | None = None,
) -> Array:
    """Return the positions of all tracked joints after posture joints were moved.

    A joint keeps its offset from its anchor, rotated with the bone that leads to the anchor.
    Where its reliability is low, its median offset is used. That offset is expressed in axes
    that the bone carries along from its mean direction, so that they rotate fast only near the
    opposite direction.

    Parameters
    ----------
    names : sequence of str
    tracked : shape (n_frames, n_joints, 3), meters
        NaN: missing.
    reliability : shape (n_frames, n_joints)
    before, after : shape (n_frames, 20, 3), meters
        Posture joints as observed, and after they were moved.
    offsets : JointOffsets, optional
        Measured in these frames by default (`measure_joint_offsets`).
    """
    if offsets is None:
        offsets = measure_joint_offsets(names, tracked, reliability, before, after)
    posture_joints = _posture_joints(names)
    result = np.empty_like(tracked)
    result[:, list(posture_joints)] = after[:, list(posture_joints.values())]
    others = [joint for joint in range(len(names)) if joint not in posture_joints]
    anchors = find_anchors(names)[others]
    bones_before, bones_after = (_bones(each)[:, anchors] for each in (before, after))
    trunk = _trunk_rotations(after)[:, None]
    axes_after = _bone_axes(trunk, bones_after, offsets.bones[others])
    rotated_offset = rotate(
        _swings(bones_before, bones_after), tracked[:, others] - before[:, anchors]
    )
    is_known = np.isfinite(rotated_offset).all(axis=-1)
    weight = np.where(is_known, reliability[:, others], 0.0)[..., None]
    offset = weight * np.where(is_known[..., None], rotated_offset, 0.0)
    offset += (1.0 - weight) * rotate(axes_after, offsets.offsets[others])
    result[:, others] = after[:, anchors] + offset
    return result


def measure_joint_offsets(
    names: Sequence[str], tracked: Array, reliability: Array, before: Array, after: Array
) -> JointOffsets:
    """Measure where the joints are that are not posture joints, in reliable frames.

    The parameters are those of `positions_from_postures`; offsets have the shape
    (n_joints, 3), meters.
    """
    posture_joints = _posture_joints(names)
    bones_before, bones_after = _bones(before), _bones(after)
    trunk = _trunk_rotations(after)
    found = JointOffsets(np.zeros((len(names), 3)), np.zeros((len(names), 3)))
    for joint, anchor in enumerate(find_anchors(names)):
        if joint in posture_joints:
            continue
        bones = bones_before[:, anchor], bones_after[:, anchor]
        found.bones[joint] = _mean_direction(trunk, bones[1])
        axes = _bone_axes(trunk, bones[0], found.bones[joint])
        tracked_offset = tracked[:, joint] - before[:, anchor]
        is_known = np.isfinite(rotate(_swings(*bones), tracked_offset)).all(axis=-1)
        weight = np.where(is_known, reliability[:, joint], 0.0)
        is_reliable = is_known & (weight >= 0.5 * weight.max(initial=0.0))
        if is_reliable.any():
            local = rotate(inverse(axes[is_reliable]), tracked_offset[is_reliable])
            found.offsets[joint] = np.median(local, axis=0)
    return found


def _posture_joints(names: Sequence[str]) -> dict[int, int]:
    """Return the posture joint of each tracked joint that is one."""
    return {
        index: POSTURE_JOINTS.index(role)
        for role, index in posture_joint_indices(names).items()
    }


def _bones(postures: Array) -> Array:
    """Return the bone that leads to each joint, (n_frames, 20, 3); for the hips the spine."""
    ends = [joint or 1 for joint in range(N_JOINTS)]
    return np.asarray(postures[:, ends] - postures[:, [PARENTS[end] for end in ends]])


def _trunk_rotations(postures: Array) -> Array:
    """Return the rotation of the trunk from a body that faces -Y, (n_frames, 4)."""
    tracked = postures[:, [POSTURE_JOINTS.index(role) for role in TRUNK]] - postures[:, :1]
    rotations = fit_rotations(np.array(list(TRUNK.values())), tracked)
    return np.where(np.isfinite(rotations), rotations, IDENTITY)


def _mean_direction(trunk: Array, bones: Array) -> Array:
    """Return the mean of a bone in axes of the trunk, shape (3,)."""
    observed = np.isfinite(bones).all(axis=-1)
    local = rotate(inverse(trunk[observed]), bones[observed])
    return np.asarray(local.mean(axis=0)) if observed.any() else np.zeros(3)


def _bone_axes(trunk: Array, bones: Array, mean: Array) -> Array:
    """Return the trunk's axes, rotated from a bone's mean direction to its current one."""
    return multiply(_swings(rotate(trunk, mean), bones), trunk)


def _swings(start: Array, stop: Array) -> Array:
    """Return the shortest rotations between directions, (n_frames, 4); NaN where one is
    unknown."""
    is_known = (np.isfinite(start) & np.isfinite(stop)).all(axis=-1, keepdims=True)
    rotations = rotation_between(np.where(is_known, start, 1.0), np.where(is_known, stop, 1.0))
    return np.where(is_known, rotations, np.nan)
