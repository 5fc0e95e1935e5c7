"""Represent a motion as curves that can be blended, without position and heading."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...motion import Motion, Skeleton
from ...motion.humanoid import normalize_postures, postures_from_motion
from ...rotations import (
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotation_vector_from_quaternion,
)

N_ROOT_CHANNELS = 4
"""Columns of the root: displacement to the left and backward in the actor's frame, and rotation
about Z, each since the frame before; then the height of the hips."""
HEIGHT_COLUMN = 3
MAX_FRAME_ROTATION_RAD = 2.0
"""Maximum plausible rotation of a joint within one frame, radians. It guards takes in which a
joint flips between two frames."""


@dataclass(frozen=True, eq=False)
class MotionCurves:
    """Curves of a motion.

    Attributes
    ----------
    root : shape (n_frames, 4), meters and radians
        See `N_ROOT_CHANNELS`; displacements of the first frame are 0.
    joints : shape (n_frames, n_joints, 3), radians
        Rotation vectors (exponential map [1]_) relative to each joint's reference rotation; the
        root's without heading.
    contact_state : shape (n_frames, 2), seconds, or None
        Signed time to the nearest contact change (`measure_contact_state`), where known.
    moving_references : shape (n_frames, n_joints, 4), or None
        Rotations to apply before each joint's reference rotation: `split_moving_references`.

    References
    ----------
    .. [1] Grassia (1998). Practical parameterization of rotations using the exponential map.
       Journal of Graphics Tools 3(3). doi:10.1080/10867651.1998.10487493
    """

    root: Array
    joints: Array
    contact_state: Array | None = None
    moving_references: Array | None = None


def headings_from_motion(motion: Motion) -> Array:
    """Return the heading of each frame: radians about Z from -Y, shape (n_frames,)."""
    normalized = normalize_postures(postures_from_motion(motion), motion.frame_rate)
    return np.asarray(np.unwrap(normalized.headings))


def remove_heading(motion: Motion, headings: Array) -> Array:
    """Return local rotations, (n_frames, n_joints, 4), of an actor who always faces -Y."""
    rotations = motion.rotations.copy()
    rotations[:, 0] = multiply(_about_z(-headings), rotations[:, 0])
    return rotations


def curves_from_motion(
    motion: Motion, headings: Array, reference_rotations: Array
) -> MotionCurves:
    """Split a motion into curves of the root and of the joints.

    Parameters
    ----------
    motion : Motion
    headings : shape (n_frames,), radians
    reference_rotations : shape (n_joints, 4)
        Each joint's rotations become rotation vectors relative to its reference.
    """
    steps = np.diff(motion.root_positions, axis=0, prepend=motion.root_positions[:1])
    before = np.concatenate([headings[:1], headings[:-1]])
    cos, sin = np.cos(before), np.sin(before)
    root = np.column_stack([
        cos * steps[:, 0] + sin * steps[:, 1],
        cos * steps[:, 1] - sin * steps[:, 0],
        np.diff(headings, prepend=headings[:1]),
        motion.root_positions[:, 2],
    ])  # fmt: skip
    relative = multiply(inverse(reference_rotations), remove_heading(motion, headings))
    return MotionCurves(
        root, unwrap_rotation_vectors(rotation_vector_from_quaternion(relative))
    )


def motion_from_curves(
    curves: MotionCurves,
    skeleton: Skeleton,
    reference_rotations: Array,
    frame_rate: float,
    start: Array,
) -> Motion:
    """Rebuild a motion from its curves: the inverse of `curves_from_motion`.

    Parameters
    ----------
    curves : MotionCurves
    skeleton : Skeleton
    reference_rotations : shape (n_joints, 4)
    frame_rate : float, hertz
    start : shape (3,)
        Initial x and y of the hips in meters, and initial heading in radians.
    """
    headings = start[2] + np.cumsum(curves.root[:, 2])
    before = np.concatenate([[start[2]], headings[:-1]])
    cos, sin = np.cos(before), np.sin(before)
    left, back = curves.root[:, 0], curves.root[:, 1]
    positions = np.column_stack([
        start[0] + np.cumsum(cos * left - sin * back),
        start[1] + np.cumsum(sin * left + cos * back),
        curves.root[:, HEIGHT_COLUMN],
    ])  # fmt: skip
    rotations = multiply(reference_rotations, quaternion_from_rotation_vector(curves.joints))
    if curves.moving_references is not None:
        rotations = multiply(curves.moving_references, rotations)
    rotations[:, 0] = multiply(_about_z(headings), rotations[:, 0])
    return Motion(skeleton, rotations, positions, frame_rate)


def _about_z(angles: Array) -> Array:
    zero = np.zeros_like(angles)
    return np.stack([np.cos(angles / 2.0), zero, zero, np.sin(angles / 2.0)], axis=-1)


def unwrap_rotation_vectors(vectors: Array) -> Array:
    """Choose equivalent rotation vectors, (n_frames, ..., 3), that never jump by a full turn.

    Of the two vectors of a rotation, it takes the one nearer to the frame before. A capture may
    flip a joint by more than `MAX_FRAME_ROTATION_RAD`; neither vector is near then. Repeated
    flips would wind the joint up without bound, so it takes the shorter vector there.
    """
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    others = vectors * (1.0 - 2.0 * np.pi / np.where(length > 0.0, length, np.inf))
    after_same, after_other = (
        _other_is_nearer(each, vectors, others) for each in (vectors, others)
    )
    chosen = np.zeros(vectors.shape[:-1], dtype=bool)
    for frame in range(1, len(vectors)):
        chosen[frame] = np.where(
            chosen[frame - 1], after_other[frame - 1], after_same[frame - 1]
        )
    return np.where(chosen[..., None], others, vectors)


def _other_is_nearer(before: Array, vectors: Array, others: Array) -> NDArray[np.bool_]:
    """Return whether the other vector of each frame continues a frame before, by joint."""
    to_same, to_other = (
        np.linalg.norm(each[1:] - before[:-1], axis=-1) for each in (vectors, others)
    )
    return np.asarray((to_other < to_same) & (to_other < MAX_FRAME_ROTATION_RAD))
