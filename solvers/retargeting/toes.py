"""Turn toes up about the axis across the foot, as far as toes bend."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from ..rotations import quaternion_from_rotation_vector, rotate

Array = NDArray[np.float64]

MOST = np.radians(32.0)
"""By how much toes are bent up, beyond the rest pose, to lift their tips."""
ABRUPTNESS = 4.0
"""Power with which turns near their limit."""
FACING = 0.4
"""Cosines of the sole's tilt, from minus it to it, over which toes come to be lifted: those of
soles that face up, as when kneeling, would turn into the ground."""
EASE = 0.1
"""Seconds before and after over which feet and toes are lifted."""
UP = np.array([0.0, 0.0, 1.0])


def toes_up(rest: Array, feet: Array, toes: Array, lift: Array, frame_rate: float) -> Array:
    """Return the world rotations, (n_frames, 4), that lift tips of toes as far as toes bend.

    Parameters
    ----------
    rest : shape (3, 3), metres
        Where ankle, ball and tip rest.
    feet : shape (n_frames, 4)
        World rotations of the foot, from its rest.
    toes : shape (n_frames, 3), metres
        The way from ball to tip.
    lift : shape (n_frames,), metres
        By how much the tip is to rise; not negative.
    frame_rate : float, hertz
    """
    foot, toe = rest[1] - rest[0], rest[2] - rest[1]
    across = np.cross(rest[2] - rest[0], UP)
    if not across.any():
        return quaternion_from_rotation_vector(np.zeros_like(toes))
    across = across / np.linalg.norm(across)
    axis = rotate(feet, across)
    bent = _angle(axis, rotate(feet, foot), toes) - _angle(across, foot, toe)
    upright = np.clip(0.5 + 0.5 * rotate(feet, UP)[:, 2] / FACING, 0.0, 1.0)
    most = upright * upright * (3.0 - 2.0 * upright) * np.maximum(MOST - bent, 0.0)
    angle = eased(np.where(lift > 0.0, _turn(axis, toes, lift), 0.0), frame_rate)
    share = 1.0 / np.maximum(most, 1e-9)
    angle = angle / (1.0 + (angle * share) ** ABRUPTNESS) ** (1.0 / ABRUPTNESS)
    return quaternion_from_rotation_vector(angle[:, None] * axis)


def eased(values: Array, frame_rate: float) -> Array:
    """Return values that are nowhere less, and come and go smoothly, shape (n_frames,)."""
    window = 2 * round(0.5 * EASE * frame_rate) + 1
    envelope = maximum_filter1d(values, window, mode="nearest")
    return np.asarray(uniform_filter1d(envelope, window, mode="nearest"))


def _turn(axis: Array, way: Array, lift: Array) -> Array:
    """Return the least angles about axes that lift ways so far, or as far as they can, radians.

    By an angle t, the height becomes c + a cos t + b sin t, which is greatest at one angle.
    """
    steady = axis[:, 2] * (axis * way).sum(axis=1)
    level = way[:, 2] - steady
    rising = np.cross(axis, way)[:, 2]
    highest = (np.arctan2(rising, level) + 0.5 * np.pi) % (2.0 * np.pi) - 0.5 * np.pi
    reach = np.maximum(np.hypot(level, rising), 1e-9)
    short = np.arccos(np.clip((level + lift) / reach, -1.0, 1.0))
    return np.asarray(np.maximum(highest - short, 0.0))


def _angle(axis: Array, start: Array, stop: Array) -> Array:
    """Return the angle about an axis from one way to another, radians."""
    across = (axis * np.cross(start, stop)).sum(axis=-1)
    along = (start * stop).sum(axis=-1) - (axis * start).sum(axis=-1) * (axis * stop).sum(
        axis=-1
    )
    return np.asarray(np.arctan2(across, along))
