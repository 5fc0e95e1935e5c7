"""Convert numbers of streams: axes of Unity, and limits that all streams share."""

import math
from collections.abc import Sequence

import numpy as np

from ....arrays import Array
from ....errors import InvalidMotionError
from ....rotations import normalize

MAX_POSITION_M = 100.0
"""Maximum distance from the origin on each axis, meters. It guards against damaged packets."""
MIN_NORM, MAX_NORM = 0.5, 2.0
"""Norms, relative to 1, of a quaternion that is a rotation, up to rounding. They guard against
damaged packets."""


def points_from_unity(points: Array) -> Array:
    """Convert points, (..., 3), of Unity: left-handed, Y up, facing +Z, the left side at -X."""
    x, y, z = np.moveaxis(points, -1, 0)
    return np.stack([-x, -z, y], axis=-1)


def points_to_unity(points: Array) -> Array:
    """Undo `points_from_unity` of points, (..., 3)."""
    x, y, z = np.moveaxis(points, -1, 0)
    return np.stack([-x, z, -y], axis=-1)


def rotations_from_unity(rotations: Array) -> Array:
    """Convert quaternions w x y z, (..., 4), of Unity.

    Mirrored axes reverse rotations: the axis of each is mirrored, then reversed.
    """
    w, x, y, z = np.moveaxis(rotations, -1, 0)
    return np.stack([w, x, z, -y], axis=-1)


def rotations_to_unity(rotations: Array) -> Array:
    """Undo `rotations_from_unity` of quaternions, (..., 4)."""
    w, x, y, z = np.moveaxis(rotations, -1, 0)
    return np.stack([w, x, -z, y], axis=-1)


def checked_positions(positions: Array) -> Array:
    """Return positions, (..., 3) meters.

    Raises
    ------
    InvalidMotionError
        One is not a number, or too far away.
    """
    if not (np.abs(positions) <= MAX_POSITION_M).all():
        limit = f"{MAX_POSITION_M:g}"
        raise InvalidMotionError(f"A frame's position is not a number up to {limit}.")
    return positions


def is_rotation(quaternion: Sequence[float]) -> bool:
    """Return whether a quaternion is a rotation, up to rounding."""
    return MIN_NORM <= math.hypot(*quaternion) <= MAX_NORM


def checked_rotations(rotations: Array) -> Array:
    """Return unit quaternions, (..., 4).

    Raises
    ------
    InvalidMotionError
        One is not a number, or far from the norm 1.
    """
    norms = np.linalg.norm(rotations, axis=-1)
    if not ((norms >= MIN_NORM) & (norms <= MAX_NORM)).all():
        raise InvalidMotionError("A frame's rotation is not a quaternion.")
    return normalize(rotations)
