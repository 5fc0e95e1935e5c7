"""A motion of a skeleton that follows tracked joints, of which only positions are known."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...rotations import IDENTITY, fit_rotations, multiply, rotate, rotation_between
from ..skeletons import Motion, Skeleton, Tracks, local_rotations
from .points_skeleton import skeleton_from_points

Array = NDArray[np.float64]
SHORT = 1e-3
"""Metres. Joints that lie nearer to each other tell no direction."""


def motion_from_points(
    tracks: Tracks, parents: Sequence[int], skeleton: Skeleton | None = None
) -> Motion:
    """Let a skeleton of constant bone lengths follow tracked joints.

    The root is where it was seen. A joint with several children turns so that they come
    nearest to where they were seen (`best_turns`). A joint with one child turns the short way
    from how its parent has turned it, for positions tell nothing of the twist about a bone. A
    joint without children does not turn.

    Parameters
    ----------
    tracks : Tracks
        One point for each joint, in any order.
    parents : sequence of int, length n_points
        The point that each hangs on; -1 for the only root.
    skeleton : Skeleton, optional
        Its joints are points of `tracks`; that of `skeleton_from_points` by default.

    Returns
    -------
    Motion
        A joint is turned in a way that nothing tells where it, its only child, or all but one
        of its children were not seen. There its rotation is NaN, and so are those of its
        children, which are measured from it.

    Raises
    ------
    InvalidMotionError
        The points do not form one tree of which anything was seen, or the skeleton has joints
        that are not among them.
    """
    body = skeleton_from_points(tracks, parents) if skeleton is None else skeleton
    if lost := [name for name in body.names if name not in tracks.names]:
        raise InvalidMotionError(
            f"The skeleton has joints that were not tracked: {', '.join(lost)}. Give none, or"
            " that of these points."
        )
    order = [tracks.names.index(name) for name in body.names]
    positions = tracks.positions[:, order]
    world = np.empty((tracks.n_frames, body.n_joints, 4))
    for joint, parent in enumerate(body.parents):
        above = (
            world[:, parent] if parent >= 0 else np.broadcast_to(IDENTITY, world[:, 0].shape)
        )
        world[:, joint] = _turned(body, joint, positions, above)
    rotations = local_rotations(body, world)
    rotations[:, [not children for children in body.children]] = IDENTITY
    return Motion(body, rotations, positions[:, 0], tracks.frame_rate)


def _turned(body: Skeleton, joint: int, positions: Array, above: Array) -> Array:
    """World rotations of a joint, shape (n_frames, 4), below one that is turned so."""
    children = [
        child for child in body.children[joint] if np.linalg.norm(body.offsets[child]) > SHORT
    ]
    if not children:
        return above
    ways = positions[:, children] - positions[:, [joint]]
    short = np.linalg.norm(np.nan_to_num(ways), axis=-1, keepdims=True) < SHORT
    ways = np.where(short, np.nan, ways)
    if len(children) > 1:
        return fit_rotations(body.offsets[children], ways)
    way, rest = ways[:, 0], rotate(above, body.offsets[children[0]])
    told = np.isfinite(way).all(axis=-1) & np.isfinite(rest).all(axis=-1)
    swing = rotation_between(
        np.where(told[:, None], rest, 1.0), np.where(told[:, None], way, 1.0)
    )
    return np.where(told[:, None], multiply(swing, above), np.nan)
