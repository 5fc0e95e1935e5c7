"""A motion as curves that can be blended: where it happens and whither it faces taken out."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..motion import Motion, Skeleton
from ..motion.humanoid import motion_postures, normalise
from ..rotations import (
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotation_vector_from_quaternion,
)

Array = NDArray[np.float64]

N_ROOT_CHANNELS = 4
"""Columns of the root's way: to the left and backward as the actor faces, and turning, each
from the frame before; and the height of the hips."""
HEIGHT = 3
IMPOSSIBLE = 2.0
"""Radians that no joint turns within a frame."""


@dataclass(frozen=True, eq=False)
class MotionCurves:
    """Curves of a motion.

    Attributes
    ----------
    root : shape (n_frames, 4), metres and radians
        See `N_ROOT`; the first frame has come from nowhere.
    joints : shape (n_frames, n_joints, 3), radians
        Rotation vectors (exponential map [1]_) about each joint's usual rotation; that of the
        root without its heading.
    footing : shape (n_frames, 2), seconds, or None
        By how much feet stand (`footing_of`), where that is known.
    carrier : shape (n_frames, n_joints, 4), or None
        What comes before each joint's usual rotation; see `tell_far_joints`.

    References
    ----------
    .. [1] Grassia (1998). Practical parameterization of rotations using the exponential map.
       Journal of Graphics Tools 3(3). doi:10.1080/10867651.1998.10487493
    """

    root: Array
    joints: Array
    footing: Array | None = None
    carrier: Array | None = None


def headings_from_motion(motion: Motion) -> Array:
    """Return the turn about Z of each frame from facing -Y, shape (n_frames,), radians."""
    found = normalise(motion_postures(motion), motion.frame_rate)
    return np.asarray(np.unwrap(found.headings))


def remove_heading(motion: Motion, turns: Array) -> Array:
    """Return local rotations, (n_frames, n_joints, 4), as if the actor always faced -Y."""
    rotations = motion.rotations.copy()
    rotations[:, 0] = multiply(_about_z(-turns), rotations[:, 0])
    return rotations


def curves_from_motion(motion: Motion, turns: Array, usual: Array) -> MotionCurves:
    """Take a motion apart.

    Parameters
    ----------
    motion : Motion
    turns : shape (n_frames,), radians
        Its headings.
    usual : shape (n_joints, 4)
        About which rotation each joint's are told.
    """
    steps = np.diff(motion.root_positions, axis=0, prepend=motion.root_positions[:1])
    before = np.concatenate([turns[:1], turns[:-1]])
    cos, sin = np.cos(before), np.sin(before)
    root = np.column_stack([
        cos * steps[:, 0] + sin * steps[:, 1],
        cos * steps[:, 1] - sin * steps[:, 0],
        np.diff(turns, prepend=turns[:1]),
        motion.root_positions[:, 2],
    ])  # fmt: skip
    told = multiply(inverse(usual), remove_heading(motion, turns))
    return MotionCurves(root, continuous(rotation_vector_from_quaternion(told)))


def motion_from_curves(
    course: MotionCurves, skeleton: Skeleton, usual: Array, frame_rate: float, start: Array
) -> Motion:
    """Put a motion together again.

    Parameters
    ----------
    course : Course
    skeleton : Skeleton
    usual : shape (n_joints, 4)
    frame_rate : float, hertz
    start : shape (3,)
        Where the hips are on the ground at first, in metres, and their heading in radians.
    """
    turns = start[2] + np.cumsum(course.root[:, 2])
    before = np.concatenate([[start[2]], turns[:-1]])
    cos, sin = np.cos(before), np.sin(before)
    left, back = course.root[:, 0], course.root[:, 1]
    places = np.column_stack([
        start[0] + np.cumsum(cos * left - sin * back),
        start[1] + np.cumsum(sin * left + cos * back),
        course.root[:, HEIGHT],
    ])  # fmt: skip
    rotations = multiply(usual, quaternion_from_rotation_vector(course.joints))
    if course.carrier is not None:
        rotations = multiply(course.carrier, rotations)
    rotations[:, 0] = multiply(_about_z(turns), rotations[:, 0])
    return Motion(skeleton, rotations, places, frame_rate)


def _about_z(angles: Array) -> Array:
    zero = np.zeros_like(angles)
    return np.stack([np.cos(angles / 2.0), zero, zero, np.sin(angles / 2.0)], axis=-1)


def continuous(vectors: Array) -> Array:
    """Let no rotation vector jump by a whole turn: of two that mean the same, the nearer.

    After a turn that nobody makes within a frame, as where a capture flips a thigh to and fro,
    neither is nearer, and two flips the same way would wind the joint up for good: there the
    shorter vector is taken.
    """
    result = vectors.copy()
    for frame in range(1, len(result)):
        length = np.linalg.norm(result[frame], axis=-1, keepdims=True)
        other = result[frame] * (1.0 - 2.0 * np.pi / np.where(length > 0.0, length, np.inf))
        stay = np.linalg.norm(result[frame] - result[frame - 1], axis=-1, keepdims=True)
        turn = np.linalg.norm(other - result[frame - 1], axis=-1, keepdims=True)
        near = (turn < stay) & (turn < IMPOSSIBLE)
        result[frame] = np.where(near, other, result[frame])
    return result
