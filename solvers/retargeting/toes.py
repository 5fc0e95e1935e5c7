"""Lift toes by extension about the axis across the foot, within a limit."""

import numpy as np
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from ..arrays import Array
from ..rotations import quaternion_from_rotation_vector, rotate
from ..signals import smoothstep

MAX_TOE_FLEXION_RAD = np.radians(32.0)
"""Maximum extension of toes beyond the rest pose to lift their tips. Chosen by hand: x0.5 and
x2 change the mean by less than 0.1 %."""
LIMIT_POWER = 4.0
"""Exponent of the smooth limit, a ratio of angles; higher is more abrupt. Chosen by hand: x0.5
and x2 change the mean by less than 0.1 %."""
FACING_COSINE = 0.4
"""Cosine of the sole's tilt, from minus this to this, over which the lift sets in. It guards
actors who kneel down: toes of soles that face up would rotate into the ground."""
LIFT_EASE_S = 0.1
"""Seconds over which the lift of feet and toes eases in and out. Chosen by hand: x0.5 costs
2.9 %, x2 gains 0.2 %."""
UP = np.array([0.0, 0.0, 1.0])


def lift_toes(rest: Array, feet: Array, toes: Array, lift: Array, frame_rate: float) -> Array:
    """Return the world rotations, (n_frames, 4), that lift the tips of toes within the limit.

    Parameters
    ----------
    rest : shape (3, 3), meters
        Rest positions of ankle, ball and tip.
    feet : shape (n_frames, 4)
        World rotations of the foot, from its rest pose.
    toes : shape (n_frames, 3), meters
        Vector from ball to tip.
    lift : shape (n_frames,), meters
        Required lift of the tip; not negative.
    frame_rate : float, hertz
    """
    foot, toe = rest[1] - rest[0], rest[2] - rest[1]
    across = np.cross(rest[2] - rest[0], UP)
    if not across.any():
        return quaternion_from_rotation_vector(np.zeros_like(toes))
    across = across / np.linalg.norm(across)
    axis = rotate(feet, across)
    flexion = _angle(axis, rotate(feet, foot), toes) - _angle(across, foot, toe)
    upward = smoothstep(0.5 + 0.5 * rotate(feet, UP)[:, 2] / FACING_COSINE)
    limit = upward * np.maximum(MAX_TOE_FLEXION_RAD - flexion, 0.0)
    angle = smooth_envelope(
        np.where(lift > 0.0, _lift_angle(axis, toes, lift), 0.0), frame_rate
    )
    inverse_limit = 1.0 / np.maximum(limit, 1e-9)
    angle = angle / (1.0 + (angle * inverse_limit) ** LIMIT_POWER) ** (1.0 / LIMIT_POWER)
    return quaternion_from_rotation_vector(angle[:, None] * axis)


def smooth_envelope(values: Array, frame_rate: float) -> Array:
    """Return a smooth upper envelope of the values, shape (n_frames,)."""
    window = 2 * round(0.5 * LIFT_EASE_S * frame_rate) + 1
    envelope = maximum_filter1d(values, window, mode="nearest")
    return np.asarray(uniform_filter1d(envelope, window, mode="nearest"))


def _lift_angle(axis: Array, toe_vector: Array, lift: Array) -> Array:
    """Return the smallest angles, radians, that lift vectors by `lift`, or as far as possible.

    After a rotation by t the height is c + a cos t + b sin t, which has one maximum.
    """
    axial_height = axis[:, 2] * (axis * toe_vector).sum(axis=1)
    cosine_term = toe_vector[:, 2] - axial_height
    sine_term = np.cross(axis, toe_vector)[:, 2]
    angle_at_top = (np.arctan2(sine_term, cosine_term) + 0.5 * np.pi) % (
        2.0 * np.pi
    ) - 0.5 * np.pi
    reach = np.maximum(np.hypot(cosine_term, sine_term), 1e-9)
    angle_below_top = np.arccos(np.clip((cosine_term + lift) / reach, -1.0, 1.0))
    return np.asarray(np.maximum(angle_at_top - angle_below_top, 0.0))


def _angle(axis: Array, start: Array, stop: Array) -> Array:
    """Return the angle about an axis from one vector to another, radians."""
    across = (axis * np.cross(start, stop)).sum(axis=-1)
    along = (start * stop).sum(axis=-1) - (axis * start).sum(axis=-1) * (axis * stop).sum(
        axis=-1
    )
    return np.asarray(np.arctan2(across, along))
