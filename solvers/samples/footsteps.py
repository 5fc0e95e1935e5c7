"""Plan foot positions and the roll of each foot over the ground.

The stride of a foot has phase 0 to 1, from one heel strike to the next of the same foot. It
rolls over the heel, stands flat, rolls over the ball, leaves at TOE_OFF, and swings.
"""

from functools import cache
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from ..arrays import Array
from ..rotations import multiply, quaternion_from_rotation_vector, rotate
from .walker import ANKLE_HEIGHT_M

TOE_OFF = 0.62
"""Phase of toe-off: the stance phase of walking takes 60 to 63 %."""
MID_STANCE = 0.225
"""Phase at which the hip passes over the ankle: the leg reaches farther back than forward."""
HEEL_OFFSET_M = np.array([0.0, 0.05, -ANKLE_HEIGHT_M])
BALL_OFFSET_M = np.array([0.0, -0.14, -0.06])
"""Pivots of the foot's roll, first the heel, then the joint of the toes, which stay flat on the
floor; from the ankle of the flat foot, meters."""

# Phase, angle of the sole (toes up positive) in degrees, its rate in degrees per stride.
SOLE_KEYS = (
    (0.00, 20.0, -330.0), (0.10, 0.0, 0.0), (0.30, 0.0, 0.0), (TOE_OFF, -56.0, -330.0),
    (0.68, -69.0, 0.0), (0.85, -8.0, 330.0), (0.96, 23.0, 0.0), (1.00, 20.0, -330.0),
)  # fmt: skip
# The same for the toes: flat while the foot stands, up on landing.
TOE_KEYS = (
    (0.00, 20.0, -330.0), (0.10, 0.0, 0.0), (TOE_OFF, 0.0, 0.0), (0.71, -33.0, 0.0),
    (0.86, 2.0, 330.0), (0.96, 27.0, 0.0), (1.00, 20.0, -330.0),
)  # fmt: skip
SWING_LIFT_M = 0.045
"""Height of the ankle in early swing above the smoothest path, meters."""
BRAKING = 5.0
"""Deceleration of the foot at landing, in strides per squared duration of the swing."""


class FootTrajectory(NamedTuple):
    """Trajectory of one foot."""

    ankles: Array
    """World positions, shape (n_frames, 3), meters."""
    foot: Array
    """World rotations of the foot, shape (n_frames, 4)."""
    toes: Array
    """World rotations of the toes, shape (n_frames, 4)."""
    phase: Array
    """Phase of the stride, shape (n_frames,); the foot is on the ground below TOE_OFF."""


def plan_foot_path(strides: Array, positions: Array, headings: Array) -> FootTrajectory:
    """Return the trajectory of a foot that stands at the given positions in order.

    Parameters
    ----------
    strides : shape (n_frames,)
        Stride and phase: 3.25 is phase .25 of the stride that stands at position 3.
    positions : shape (n_strides, 3), meters
        Of the ankle while the foot stands flat.
    headings : shape (n_strides,), radians
        Direction of the foot there, about Z; 0 faces -Y.
    """
    stride = np.floor(strides).astype(np.intp)
    phase = strides - stride
    swing = np.clip((phase - TOE_OFF) / (1.0 - TOE_OFF), 0.0, 1.0)
    heading_change = headings[stride + 1] - headings[stride]
    yaw = headings[stride] + heading_change * swing**3 * (10.0 - 15.0 * swing + 6.0 * swing**2)
    standing = _standing_ankle(positions[stride], headings[stride], phase)
    swinging = _swinging_ankle(positions, headings, stride, swing)
    ankles = np.where((phase < TOE_OFF)[:, None], standing, swinging)
    return FootTrajectory(
        ankles,
        _foot_rotation(yaw, _angle_curve(SOLE_KEYS)(phase)),
        _foot_rotation(yaw, _angle_curve(TOE_KEYS)(phase)),
        phase,
    )


def _standing_ankle(position: Array, heading: Array, phase: Array) -> Array:
    """Return ankles that rotate about the heel while the toes are up, otherwise about the
    ball."""
    angle = _angle_curve(SOLE_KEYS)(phase)
    pivot = np.where((angle > 0.0)[:, None], HEEL_OFFSET_M, BALL_OFFSET_M)
    flat = _foot_rotation(heading, np.zeros_like(heading))
    return np.asarray(
        position + rotate(flat, pivot) - rotate(_foot_rotation(heading, angle), pivot)
    )


def _swinging_ankle(
    positions: Array, headings: Array, stride: NDArray[np.intp], swing: Array
) -> Array:
    """Return the path of degree five between the velocities of the standing foot.

    It lifts the foot off the floor at the start and brakes it at the end.
    """
    start = _derivatives(positions[stride], headings[stride], TOE_OFF)
    end = _derivatives(positions[stride + 1], headings[stride + 1], 0.0)
    end[2] -= BRAKING * (end[0] - start[0])
    s = swing[:, None]
    lift = SWING_LIFT_M * (3.0 * swing) ** 2 * (1.5 * (1.0 - swing)) ** 4  # 1 at a third
    return np.asarray(_hermite(start, end, s) + lift[:, None] * [0.0, 0.0, 1.0])


def _derivatives(positions: Array, headings: Array, phase: float) -> list[Array]:
    """Return position, velocity and acceleration of standing ankles; time is in swings."""
    step = 1e-4 if phase == 0.0 else -1e-4  # stay inside the standing phase
    at = [
        _standing_ankle(positions, headings, np.full(len(positions), phase + n * step))
        for n in range(4)
    ]
    scale = (1.0 - TOE_OFF) / step
    velocity = (-11.0 * at[0] + 18.0 * at[1] - 9.0 * at[2] + 2.0 * at[3]) / 6.0
    acceleration = 2.0 * at[0] - 5.0 * at[1] + 4.0 * at[2] - at[3]
    return [at[0], velocity * scale, acceleration * scale**2]


def _hermite(start: list[Array], stop: list[Array], s: Array) -> Array:
    """Return the polynomial of degree five with given value and derivatives at s = 0 and s =
    1."""
    (p, v, a), (q, w, b) = start, stop
    gap, slope, acceleration_gap = q - p - v - a / 2.0, w - v - a, b - a
    return np.asarray(
        p + v * s + a * s**2 / 2.0
        + (10.0 * gap - 4.0 * slope + acceleration_gap / 2.0) * s**3
        + (-15.0 * gap + 7.0 * slope - acceleration_gap) * s**4
        + (6.0 * gap - 3.0 * slope + acceleration_gap / 2.0) * s**5
    )  # fmt: skip


def _foot_rotation(yaw: Array, toes_up: Array) -> Array:
    """Rotate by `yaw` about Z after raising the toes by an angle, both in radians."""
    zero = np.zeros_like(yaw)
    yaw_rotation = quaternion_from_rotation_vector(np.stack([zero, zero, yaw], axis=-1))
    pitch_rotation = quaternion_from_rotation_vector(np.stack([-toes_up, zero, zero], axis=-1))
    return multiply(yaw_rotation, pitch_rotation)


@cache
def _angle_curve(rows: tuple[tuple[float, float, float], ...]) -> "scipy.interpolate.BPoly":
    """Return a smooth curve over one stride, in radians, without acceleration at its knots."""
    phases = [phase for phase, _, _ in rows]
    values = [(np.radians(angle), np.radians(rate), 0.0) for _, angle, rate in rows]
    return scipy.interpolate.BPoly.from_derivatives(phases, values)
