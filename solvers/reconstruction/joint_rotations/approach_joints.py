"""Rotate all joints a little so that together they come nearer to observed positions."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...motion import Motion, Skeleton, forward_kinematics
from ...rotations import inverse, multiply, quaternion_from_rotation_vector, rotate

ROTATION_WEIGHT_M2 = 0.01
"""Weight of a rotation (m² per rad²): a joint that turns by 0.1 rad costs as much as a joint
that misses by 1 cm. Chosen by hand on subjects 2 and 5 of UI-PRMD: x0.3 and x3 change the mean
error by 0.5 %."""
DISPLACEMENT_WEIGHT = 0.01
"""Weight of a displacement of the root; a reliable joint has weight 1. It guards a division
where no joint is observed."""


def approach_joints(motion: Motion, positions: Array, weights: Array) -> Motion:
    """Move a motion toward joint positions: one Gauss-Newton step of least squares.

    Bones that are aimed one after another add up the errors of rigid hips and shoulders. The
    step changes all rotations and the root of a frame at once, as little as possible: no bone
    rotates about its own axis, unless adjacent joints require it.

    Parameters
    ----------
    motion : Motion
        Near the positions. Frames with unknown rotations stay unchanged.
    positions : shape (n_frames, n_joints, 3), meters
        Observed joints; NaN where unknown.
    weights : shape (n_frames, n_joints), 0 to any
        0 where a joint is to be ignored.
    """
    reached = forward_kinematics(motion)
    is_complete = np.isfinite(reached.positions).all(axis=(1, 2))
    is_known = np.isfinite(positions).all(axis=-1) & is_complete[:, None]
    scale = np.sqrt(np.where(is_known, weights, 0.0))
    moved = _moved_joints(motion.skeleton)
    turning = np.flatnonzero(moved.any(axis=0))
    slopes = _slopes(np.nan_to_num(reached.positions), moved[:, turning], turning)
    slopes *= np.repeat(scale, 3, axis=1)[..., None]
    missing = np.where(is_known[..., None], positions - reached.positions, 0.0)
    missing = (missing * scale[..., None]).reshape(len(scale), -1, 1)
    steps = slopes.swapaxes(1, 2)
    n_turns = 3 * len(turning)
    ridge = np.full(n_turns + 3, DISPLACEMENT_WEIGHT)
    ridge[:n_turns] = ROTATION_WEIGHT_M2
    found = np.linalg.solve(steps @ slopes + np.diag(ridge), steps @ missing)[..., 0]
    turns = found[:, :n_turns].reshape(len(found), -1, 3)
    rotations = motion.rotations.copy()
    for index, joint in enumerate(turning):
        parent = motion.skeleton.parents[joint]
        turn = turns[:, index]
        if parent >= 0:
            turn = rotate(inverse(reached.rotations[:, parent]), turn)
        rotations[:, joint] = multiply(
            quaternion_from_rotation_vector(turn), rotations[:, joint]
        )
    rotations = np.where(is_complete[:, None, None], rotations, motion.rotations)
    return motion.with_poses(rotations, motion.root_positions + found[:, n_turns:])


def _moved_joints(skeleton: Skeleton) -> NDArray[np.bool_]:
    """Return whether a joint (row) is below another one (column), (n_joints, n_joints)."""
    result = np.zeros((skeleton.n_joints, skeleton.n_joints), np.bool_)
    for joint in range(skeleton.n_joints):
        result[joint, list(skeleton.ancestors(joint))] = True
        result[joint, joint] = False
    return result


def _slopes(positions: Array, moved: NDArray[np.bool_], turning: NDArray[np.intp]) -> Array:
    """Return how joints move with the rotations of some and with the root.

    The derivative of p by a rotation vector about q is the matrix -[p - q]x.

    Returns
    -------
    shape (n_frames, 3 n_joints, 3 n_turning + 3)
    """
    arms = positions[:, :, None] - positions[:, None, turning]
    arms *= moved[..., None]
    n_frames, n_joints = positions.shape[:2]
    slopes = np.zeros((n_frames, n_joints, 3, len(turning) + 1, 3))
    for row, (first, second) in enumerate(((1, 2), (2, 0), (0, 1))):
        slopes[:, :, row, :-1, first] = arms[..., second]
        slopes[:, :, row, :-1, second] = -arms[..., first]
        slopes[:, :, row, -1, row] = 1.0
    return slopes.reshape(n_frames, 3 * n_joints, -1)
