"""From positions and world rotations of joints to the motion of rigid bones."""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import Motion, Skeleton
from ...rotations import inverse, multiply, rotate

MAX_OFFSET_ERROR = 0.0125
"""Standard deviation of a bone over time, relative to the size of the body, above which
positions and rotations disagree. Measured: 2 cm of an adult. The trunk of a take of Theia3D,
which bends between its two segments, has 0.010, MVNX and Kimodo at most 0.0001."""


def motion_from_world_poses(
    names: Sequence[str],
    parents: Sequence[int],
    positions: Array,
    rotations: Array,
    frame_rate: float,
) -> Motion:
    """Return the motion whose bones are the mean of the joints seen from their parents.

    Parameters
    ----------
    names, parents : of the joints, parents first
    positions : shape (n_frames, n_joints, 3), meters, Z up; NaN where missing
    rotations : shape (n_frames, n_joints, 4), in the world, 1 in the rest pose
    frame_rate : float, hertz

    Raises
    ------
    InvalidFileError
        No frame is complete, or joints do not stay where the rotations put them.
    """
    above = np.maximum(parents, 0)
    complete = np.isfinite(positions).all(axis=(1, 2)) & np.isfinite(rotations).all(axis=(1, 2))
    bones = rotate(inverse(rotations[:, above]), positions - positions[:, above])[complete]
    if not len(bones) or bones.std(axis=0).max() > MAX_OFFSET_ERROR * body_extent(positions):
        raise InvalidFileError("positions and rotations of the joints do not agree")
    offsets = bones.mean(axis=0)
    offsets[0] = positions[complete, 0].mean(axis=0)
    local = np.where(complete[:, None, None], rotations, np.nan)
    local = multiply(inverse(local[:, above]), local)
    local[:, 0] = rotations[:, 0]
    skeleton = Skeleton(tuple(names), tuple(int(parent) for parent in parents), offsets)
    return Motion(skeleton, local, positions[:, 0], frame_rate)


def body_extent(positions: Array) -> float:
    """Return the median of the largest side of the box around (n_frames, n_joints, 3)."""
    complete = np.isfinite(positions).all(axis=(1, 2))
    boxes = np.ptp(positions[complete], axis=1).max(axis=-1)
    return float(np.median(boxes)) if len(boxes) else 0.0
