"""Fit the motion of a skeleton to tracked joint positions."""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array
from ...errors import InvalidMotionError
from ...rotations import IDENTITY, fit_rotations, multiply, rotate, rotation_between
from ..skeletons import MIN_BONE_M, Motion, Skeleton, Tracks, local_rotations
from .points_skeleton import skeleton_from_points


def motion_from_points(
    tracks: Tracks, parents: Sequence[int], skeleton: Skeleton | None = None
) -> Motion:
    """Fit the motion of a skeleton with constant bone lengths to tracked joints.

    The root is at its tracked position. A joint with several children gets the rotation that
    brings them nearest to their tracked positions (`fit_rotations`). A joint with one child
    gets the shortest rotation from its parent's: positions do not determine the twist about a
    bone. A joint without children does not rotate.

    Parameters
    ----------
    tracks : Tracks
        One point for each joint, in any order.
    parents : sequence of int, length n_points
        Index of each point's parent; -1 for the only root.
    skeleton : Skeleton, optional
        With points of `tracks` as joints; by default from `skeleton_from_points`.

    Returns
    -------
    Motion
        A rotation is undetermined where the joint, its only child, or all but one of its
        children are missing. It is NaN there, and so are the local rotations of its children.

    Raises
    ------
    InvalidMotionError
        The points do not form one hierarchy with observed bones, or the skeleton has other
        joints.
    """
    body = skeleton_from_points(tracks, parents) if skeleton is None else skeleton
    if untracked := [name for name in body.names if name not in tracks.names]:
        raise InvalidMotionError(
            f"The skeleton has joints that were not tracked: {', '.join(untracked)}. Pass no"
            " skeleton, or one of these points."
        )
    order = [tracks.names.index(name) for name in body.names]
    positions = tracks.positions[:, order]
    world = np.empty((tracks.n_frames, body.n_joints, 4))
    for joint, parent in enumerate(body.parents):
        parent_rotation = (
            world[:, parent] if parent >= 0 else np.broadcast_to(IDENTITY, world[:, 0].shape)
        )
        world[:, joint] = _world_rotations(body, joint, positions, parent_rotation)
    rotations = local_rotations(body, world)
    rotations[:, [not children for children in body.children]] = IDENTITY
    return Motion(body, rotations, positions[:, 0], tracks.frame_rate)


def _world_rotations(
    body: Skeleton, joint: int, positions: Array, parent_rotation: Array
) -> Array:
    """Return the world rotations of a joint, shape (n_frames, 4), given its parent's."""
    children = [
        child
        for child in body.children[joint]
        if np.linalg.norm(body.offsets[child]) > MIN_BONE_M
    ]
    if not children:
        return parent_rotation
    directions = positions[:, children] - positions[:, [joint]]
    is_short = np.linalg.norm(np.nan_to_num(directions), axis=-1, keepdims=True) < MIN_BONE_M
    directions = np.where(is_short, np.nan, directions)
    if len(children) > 1:
        return fit_rotations(body.offsets[children], directions)
    direction, rest = directions[:, 0], rotate(parent_rotation, body.offsets[children[0]])
    determined = np.isfinite(direction).all(axis=-1) & np.isfinite(rest).all(axis=-1)
    swing = rotation_between(
        np.where(determined[:, None], rest, 1.0), np.where(determined[:, None], direction, 1.0)
    )
    return np.where(determined[:, None], multiply(swing, parent_rotation), np.nan)
