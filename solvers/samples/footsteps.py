"""Where and when a walker puts the feet, and how each foot rolls over the ground.

A stride of one foot has phase 0 to 1, from one heel strike to the next of the same foot:
it rolls over the heel, stands flat, rolls over the ball, leaves at TOE_OFF, and swings.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BPoly

from ..rotations import multiply, quaternion_from_rotation_vector, rotate
from .walker import ANKLE_HEIGHT

Array = NDArray[np.float64]

TOE_OFF = 0.62
"""Phase at which the foot leaves the ground: walkers stand on a foot for 60 to 63 %."""
UNDER_HIP = 0.225
"""Phase at which the hip passes over the ankle: the leg reaches farther back than forward."""
HEEL = np.array([0.0, 0.05, -ANKLE_HEIGHT])
BALL = np.array([0.0, -0.14, -0.06])
"""Where the foot rolls, first on the heel, then about the joint of the toes, which stay flat
on the floor; from the ankle of the flat foot, metres."""

# Phase, angle of the sole (toes up positive) in degrees, its rate in degrees per stride.
SOLE = (
    (0.00, 20.0, -330.0), (0.10, 0.0, 0.0), (0.30, 0.0, 0.0), (TOE_OFF, -56.0, -330.0),
    (0.68, -69.0, 0.0), (0.85, -8.0, 330.0), (0.96, 23.0, 0.0), (1.00, 20.0, -330.0),
)  # fmt: skip
# The same for the toes: flat while the foot stands, up on landing.
TOES = (
    (0.00, 20.0, -330.0), (0.10, 0.0, 0.0), (TOE_OFF, 0.0, 0.0), (0.71, -33.0, 0.0),
    (0.86, 2.0, 330.0), (0.96, 27.0, 0.0), (1.00, 20.0, -330.0),
)  # fmt: skip
SWING_LIFT = 0.045
"""How much higher the ankle goes in early swing than the smoothest path would, metres."""
BRAKING = 5.0
"""How hard the foot is stopped as it lands, in strides per squared duration of the swing."""


class FootPath(NamedTuple):
    """One foot over time."""

    ankles: Array
    """World positions, shape (n_frames, 3), metres."""
    foot: Array
    """World rotations of the foot, shape (n_frames, 4)."""
    toes: Array
    """World rotations of the toes, shape (n_frames, 4)."""
    phase: Array
    """Phase of the stride, shape (n_frames,); the foot is on the ground below TOE_OFF."""


def foot_path(strides: Array, places: Array, headings: Array) -> FootPath:
    """Return the way of a foot that stands at given places one after the other.

    Parameters
    ----------
    strides : shape (n_frames,)
        Which stride, and how far in it: 3.25 is phase .25 of the stride that stands on place 3.
    places : shape (n_strides, 3), metres
        Where the ankle is while the foot stands flat.
    headings : shape (n_strides,), radians
        Direction of the foot there, about Z; 0 faces -Y.
    """
    stride = np.floor(strides).astype(np.intp)
    phase = strides - stride
    swing = np.clip((phase - TOE_OFF) / (1.0 - TOE_OFF), 0.0, 1.0)
    turn = headings[stride + 1] - headings[stride]
    yaw = headings[stride] + turn * swing**3 * (10.0 - 15.0 * swing + 6.0 * swing**2)
    standing = _standing_ankle(places[stride], headings[stride], phase)
    swinging = _swinging_ankle(places, headings, stride, swing)
    ankles = np.where((phase < TOE_OFF)[:, None], standing, swinging)
    return FootPath(ankles, _tilted(yaw, _SOLE(phase)), _tilted(yaw, _TOES(phase)), phase)


def _standing_ankle(place: Array, heading: Array, phase: Array) -> Array:
    """The ankle turns about the heel while the toes are up, else about the ball."""
    angle = _SOLE(phase)
    pivot = np.where((angle > 0.0)[:, None], HEEL, BALL)
    flat = _tilted(heading, np.zeros_like(heading))
    return np.asarray(place + rotate(flat, pivot) - rotate(_tilted(heading, angle), pivot))


def _swinging_ankle(
    places: Array, headings: Array, stride: NDArray[np.intp], swing: Array
) -> Array:
    """The path of degree five that leaves and lands with the velocity of the standing foot,
    is pulled off the floor at the start and braked by it at the end.
    """
    leave = _derivatives(places[stride], headings[stride], TOE_OFF)
    land = _derivatives(places[stride + 1], headings[stride + 1], 0.0)
    land[2] -= BRAKING * (land[0] - leave[0])
    s = swing[:, None]
    lift = SWING_LIFT * (3.0 * swing) ** 2 * (1.5 * (1.0 - swing)) ** 4  # 1 at a third
    return np.asarray(_hermite(leave, land, s) + lift[:, None] * [0.0, 0.0, 1.0])


def _derivatives(places: Array, headings: Array, phase: float) -> list[Array]:
    """Position, velocity and acceleration of standing ankles, for time in whole swings."""
    step = 1e-4 if phase == 0.0 else -1e-4  # stay inside the standing phase
    at = [
        _standing_ankle(places, headings, np.full(len(places), phase + n * step))
        for n in range(4)
    ]
    scale = (1.0 - TOE_OFF) / step
    velocity = (-11.0 * at[0] + 18.0 * at[1] - 9.0 * at[2] + 2.0 * at[3]) / 6.0
    acceleration = 2.0 * at[0] - 5.0 * at[1] + 4.0 * at[2] - at[3]
    return [at[0], velocity * scale, acceleration * scale**2]


def _hermite(start: list[Array], stop: list[Array], s: Array) -> Array:
    """Polynomial of degree five with given value and two derivatives at s = 0 and s = 1."""
    (p, v, a), (q, w, b) = start, stop
    gap, slope, bend = q - p - v - a / 2.0, w - v - a, b - a
    return np.asarray(
        p + v * s + a * s**2 / 2.0
        + (10.0 * gap - 4.0 * slope + bend / 2.0) * s**3
        + (-15.0 * gap + 7.0 * slope - bend) * s**4
        + (6.0 * gap - 3.0 * slope + bend / 2.0) * s**5
    )  # fmt: skip


def _tilted(yaw: Array, toes_up: Array) -> Array:
    """Turn by `yaw` about Z after raising the toes by an angle, both in radians."""
    zero = np.zeros_like(yaw)
    turned = quaternion_from_rotation_vector(np.stack([zero, zero, yaw], axis=-1))
    raised = quaternion_from_rotation_vector(np.stack([-toes_up, zero, zero], axis=-1))
    return multiply(turned, raised)


def _profile(rows: tuple[tuple[float, float, float], ...]) -> BPoly:
    """Smooth curve over one stride, in radians, without acceleration at its knots."""
    phases = [phase for phase, _, _ in rows]
    values = [(np.radians(angle), np.radians(rate), 0.0) for _, angle, rate in rows]
    return BPoly.from_derivatives(phases, values)


_SOLE = _profile(SOLE)
_TOES = _profile(TOES)
