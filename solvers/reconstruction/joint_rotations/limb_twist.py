"""How far upper arms and thighs are twisted about themselves: elbows and knees tell it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from ...motion import Skeleton
from ...rotations import inverse, multiply, quaternion_from_rotation_vector, rotate
from .limb_angles import Complex, axial_angles, measure_flexion, unit_vectors

Array = NDArray[np.float64]

HINGES = {"Arm": (0.0, -1.0, 0.0), "Leg": (0.0, 1.0, 0.0)}
"""Where an elbow or a knee brings what is below it, in a T-pose that faces -Y."""
MIN_FLEXION, FULL_FLEXION = np.radians([8.0, 30.0])
"""Bends at which the plane begins to be told, and is fully told."""
SMOOTHING_S = 0.1
"""Seconds over which the twist is steadied where bends tell it."""
REST_WEIGHT = 0.02
"""Weight of no twist against the trunk; a bend has 1."""
LIBRARY_WEIGHT, OBSERVED_FRACTION = 0.2, 0.1
"""Weight of the twist that like postures agree upon where the limb is lost, and what part of it
is left where the limb is seen: bends before and after tell more of a straight one."""
ACTOR_BIAS_S = 0.03
"""Seconds of bends by which half of how the actor differs from like postures is known."""

AGREED_WEIGHT, MIN_WEIGHT = 90.0, 1e-6
"""Weights of an angle that all bends about it agree on, and of one of which nothing is told;
that of a change by as much within `STEADY` is 1."""
MIN_PALM_M, FULL_PALM_M = 0.02, 0.05
"""Metres. A palm that is seen nearer to its wrist tells no direction; beyond the second it
does."""
MAX_PALM_FLEXION, FULL_PALM_FLEXION = np.radians([100.0, 70.0])
"""Bends of a palm against its forearm that are wrong, and up to which all are right."""


class Limb(NamedTuple):
    """Joints of an arm or a leg."""

    upper: int
    lower: int
    end: int
    bends_towards: tuple[float, float, float]
    role: str = ""
    """Of the upper joint."""


class ExpectedTwists(NamedTuple):
    """Twists of like postures, as complex numbers that are as long as they agree.

    Attributes
    ----------
    twists : complex, shape (n_frames,)
    weights : shape (n_frames,)
        What they count for against a bend.
    """

    twists: Complex
    weights: Array


class HingeAxes(NamedTuple):
    """Where like postures have the axis of an elbow or a knee.

    Attributes
    ----------
    ways : shape (n_frames, 3), optional
        In the world, as long as they agree; none where no postures were asked.
    alone : bool
        Whether nothing else is to tell the twist, frame by frame. Where they tell none, there
        is none.
    """

    ways: Array | None = None
    alone: bool = False


UNKNOWN_HINGES = HingeAxes()


def rotations_from_flexion(
    turns: Array,
    limb: Limb,
    skeleton: Skeleton,
    places: Array,
    trust: Array,
    frame_rate: float,
    known: HingeAxes = UNKNOWN_HINGES,
) -> Array:
    """Twist an upper arm or thigh about itself until its hinge bends as it was seen to bend.

    The twist of each frame is a point on a circle. What bends tell of it is weighed by how far
    they bend and are trusted, and by how near they are to what a joint can do; the path is the
    one that fits them best while it is steady and near to the twist of like postures, or else
    to no twist at all (least squares in the plane of the circle; where that path passes near
    the circle's middle it is led over).

    Parameters
    ----------
    turns : shape (n_frames, 4)
        World rotations of the upper joint that point it the right way.
    limb : Limb
    skeleton : Skeleton
        In a T-pose.
    places : shape (n_frames, n_joints, 3), metres
    trust : shape (n_frames, n_joints), 0 to 1
    frame_rate : float, hertz
    known : Hinges

    Returns
    -------
    NDArray, shape (n_frames, 4)
        NaN where `turns` are.
    """
    along = unit_vectors(skeleton.offsets[limb.lower])
    axis = rotate(turns, along)
    hinge = rotate(turns, unit_vectors(np.cross(along, limb.bends_towards)))
    normal, bend = measure_flexion(
        axis, unit_vectors(places[:, limb.end] - places[:, limb.lower])
    )
    sure = np.min(trust[:, [limb.upper, limb.lower, limb.end]], axis=1)
    like = np.zeros(len(turns), np.complex128)
    if known.ways is not None:
        like = _angles_or_zero(axis, hinge, known.ways) * np.linalg.norm(known.ways, axis=-1)
    if known.alone:
        return _rotate_about_axis(turns, axis, np.angle(like))
    expected = ExpectedTwists(like, LIBRARY_WEIGHT * (1.0 - (1.0 - OBSERVED_FRACTION) * sure))
    return twist_to_normal(
        turns, axis, hinge, normal, flexion_weights(bend) * sure, frame_rate, expected
    )


def flexion_weights(bends: Array) -> Array:
    """Return how far the plane of a bend, in radians, is told: 0 to 1."""
    return np.asarray(np.clip((bends - MIN_FLEXION) / (FULL_FLEXION - MIN_FLEXION), 0, 1))


def rotations_from_thumb(
    turns: Array, along: Array, thumb: Array, seen: Array, trust: Array, frame_rate: float
) -> Array:
    """Twist a hand about itself until its thumb lies where it was seen to lie, steadily.

    Parameters
    ----------
    turns : shape (n_frames, 4)
        World rotations of the wrist that point the hand the right way.
    along, thumb : shape (3,)
        Ways to hand and thumb in the rest pose.
    seen : shape (n_frames, 3)
        The way to the thumb.
    trust : shape (n_frames,), 0 to 1
    frame_rate : float, hertz
    """
    axis = rotate(turns, unit_vectors(along))
    usual = rotate(turns, unit_vectors(np.cross(along, thumb)))
    normal = np.cross(axis, unit_vectors(seen))
    return twist_to_normal(
        turns, axis, usual, normal, trust * np.linalg.norm(normal, axis=-1), frame_rate
    )


def smooth_direction(
    seen: Array, above: Array, straight_on: Array, trust: Array, frame_rate: float
) -> Array:
    """Return a short way whose direction is steadied over a tenth of a second, as trusted.

    A camera sees the tips of hands to a few centimetres: on so short a bone that is half a
    right angle. The bone above is what the way is steady against; where it is not trusted at
    all, it goes straight on.

    Parameters
    ----------
    seen : shape (n_frames, 3)
    above : shape (n_frames, 4)
        World rotations of the joint above.
    straight_on : shape (3,)
        The bone above in the rest pose.
    trust : shape (n_frames,), 0 to 1
    frame_rate : float, hertz
    """
    local = rotate(inverse(above), unit_vectors(seen))
    told = np.isfinite(local).all(axis=-1)
    weights = np.where(told, trust * _palm_weights(seen, local, straight_on), 0.0)
    mixed = weights[:, None] * np.where(told[:, None], local, 0.0) + REST_WEIGHT * unit_vectors(
        straight_on
    )
    steady = unit_vectors(
        solve_smooth_paths(mixed, weights + REST_WEIGHT, (SMOOTHING_S * frame_rate) ** 2)
    )
    lengths = np.linalg.norm(seen, axis=-1, keepdims=True)
    return np.asarray(rotate(above, steady) * lengths)


def _palm_weights(seen: Array, local: Array, straight_on: Array) -> Array:
    """Return 0 for ways that are too short or too far folded to be a palm's, 1 for others."""
    length = np.linalg.norm(seen, axis=-1)
    bend = np.arccos(np.clip(local @ unit_vectors(straight_on), -1.0, 1.0))
    long = np.clip((length - MIN_PALM_M) / (FULL_PALM_M - MIN_PALM_M), 0.0, 1.0)
    return np.asarray(
        long
        * np.clip((MAX_PALM_FLEXION - bend) / (MAX_PALM_FLEXION - FULL_PALM_FLEXION), 0.0, 1.0)
    )


def twist_to_normal(
    turns: Array,
    axis: Array,
    usual: Array,
    normal: Array,
    weights: Array,
    frame_rate: float,
    expected: ExpectedTwists | None = None,
) -> Array:
    """Twist frames about their `axis` so far that `usual` comes to `normal`, where it counts.

    Arrays of shape (n_frames, 3) are in the world; `weights` has shape (n_frames,). What is not
    known of the twist that is `expected` is none at all.
    """
    seen = _angles_or_zero(axis, usual, normal)
    weights = np.where(seen != 0.0, weights * (0.5 + 0.5 * seen.real), 0.0)
    stiffness = (SMOOTHING_S * frame_rate) ** 2
    told, sure = weights * seen + REST_WEIGHT, weights + REST_WEIGHT
    if expected is not None:
        like = _remove_actor_bias(expected.twists, seen, weights, frame_rate)
        known = np.abs(like)
        told += expected.weights * like - REST_WEIGHT * known
        sure += (expected.weights - REST_WEIGHT) * known
    parts = solve_smooth_paths(np.stack([told.real, told.imag], -1), sure, stiffness)
    path = np.asarray(parts[:, 0] + 1j * parts[:, 1])
    return _rotate_about_axis(turns, axis, _smooth_angles(path, stiffness))


def _remove_actor_bias(
    like: Complex, seen: Complex, weights: Array, frame_rate: float
) -> Complex:
    """Turn the twist of like postures by how the actor mostly differs where limbs bend."""
    off = ACTOR_BIAS_S * frame_rate + np.sum(weights * seen * np.conj(like))
    return np.asarray(like * off / max(abs(off), MIN_WEIGHT))


def _angles_or_zero(directions: Array, plain: Array, hinges: Array) -> Complex:
    """Return `angles_about`; 0: unknown."""
    return np.nan_to_num(axial_angles(directions, plain, hinges))


def _rotate_about_axis(turns: Array, axis: Array, angles: Array) -> Array:
    return multiply(quaternion_from_rotation_vector(angles[:, None] * axis), turns)


def _smooth_angles(path: Complex, stiffness: float) -> Array:
    """Return the angles of a path in the plane, radians, shape (n_frames,).

    Where the path passes near 0 an angle may change by half a turn in a frame. There it tells
    little, and is led over steadily.
    """
    weights = AGREED_WEIGHT * np.abs(path) ** 4 + MIN_WEIGHT
    told = weights * np.unwrap(np.angle(path))
    return solve_smooth_paths(told[:, None], weights, stiffness)[:, 0]


def solve_smooth_paths(told: Array, weights: Array, stiffness: float) -> Array:
    """Solve (W + s D'D) z = told for paths z, shape (n_frames, n)."""
    n_frames = len(told)
    if n_frames == 1:
        return np.asarray(told / weights[:, None])
    ends = np.full(n_frames, 2.0)
    ends[0] -= 1.0
    ends[-1] -= 1.0
    bands = np.zeros((2, n_frames))
    bands[0, 1:] = -stiffness
    bands[1] = weights + stiffness * ends
    return np.asarray(solveh_banded(bands, told))
