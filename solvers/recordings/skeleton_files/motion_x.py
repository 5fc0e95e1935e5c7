"""Read the arrays of Motion-X: an SMPL-X body without bone lengths."""

from dataclasses import replace

from ...arrays import Array
from ...motion import Motion, Skeleton
from ...progress import Progress
from ...rotations import quaternion_from_rotation_vector
from ..conventions import (
    DEFAULT_FRAME_RATE,
    file_conventions,
    put_on_floor,
    rotations_z_up_from_y_up,
    stand_upright,
    z_up_from_y_up,
)
from .smpl_bodies import N_BODY, N_HAND, VIDEO_UP, smpl_joints

MOTION_X_COLUMNS = 322
MOTION_X_POSITION = slice(309, 312)
"""Columns of the position, after root, body, hands, jaw, expression and shape of the face."""


def is_motion_x(shape: tuple[int, ...]) -> bool:
    """Return whether an array has the columns of Motion-X."""
    return len(shape) == 2 and shape[0] > 0 and shape[1] == MOTION_X_COLUMNS


def read_motion_x(
    columns: Array, scale: float | None, height: float, on_floor: bool, progress: Progress
) -> Motion:
    """Return the motion of a Motion-X array, shape (n_frames, 322): SMPL-X at 30 Hz.

    Its columns are the rotations of root, body and hands, face and shape, which are left out,
    and the position.
    """
    vectors = columns[:, : 3 * (N_BODY + 2 * N_HAND // 3)].reshape(len(columns), -1, 3)
    names, parents, offsets = smpl_joints(hands=True, height=height)
    unit = 1.0 if scale is None else scale
    motion = Motion(
        Skeleton(names, parents, z_up_from_y_up(offsets)),
        rotations_z_up_from_y_up(quaternion_from_rotation_vector(vectors)),
        z_up_from_y_up(columns[:, MOTION_X_POSITION] * unit),
        DEFAULT_FRAME_RATE,
        replace(file_conventions("Y", unit=unit), has_floor=False),
    )
    standing = stand_upright(motion, progress, VIDEO_UP)
    return put_on_floor(standing) if on_floor else standing
