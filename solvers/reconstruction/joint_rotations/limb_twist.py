"""Axial rotation of upper arms and thighs from the flexion plane of elbow and knee."""

from typing import NamedTuple

import numpy as np
import scipy

from ...arrays import Array
from ...motion import Skeleton
from ...rotations import cross, inverse, multiply, quaternion_from_rotation_vector, rotate
from .limb_angles import Complex, axial_angles, measure_flexion, unit_vectors

HINGES = {"Arm": (0.0, -1.0, 0.0), "Leg": (0.0, 1.0, 0.0)}
"""Direction in which an elbow or a knee flexes, in a T-pose that faces -Y."""
MIN_FLEXION, FULL_FLEXION = np.radians([8.0, 30.0])
"""Flexion angles (radians) between which the weight of the flexion plane rises from 0 to 1."""
TWIST_TIME_S = 0.1
"""Time (s) over which the axial rotation is smoothed where the limb is flexed. Half and twice
gain less than 1 % (`make sensitivity`)."""
REST_WEIGHT = 0.02
"""Weight of zero axial rotation relative to the trunk; a flexed limb has weight 1. Sweep: x10
costs 2 % on one take."""
LIBRARY_WEIGHT = 0.2
"""Weight of the library's axial rotation for missing limbs; observed ones have `REST_WEIGHT`.
It guards limbs that are straight or missing, which would have no axial rotation
(`test_straight_arm_gets_the_twist_of_similar_postures`)."""
ACTOR_BIAS_S = 0.03
"""Time (s) of flexed frames at which the actor's deviation from the library gets half weight.
It guards limbs that hardly flex, which would lose the library's rotation
(`test_straight_arm_gets_the_twist_of_similar_postures`)."""
AGREED_WEIGHT = 90.0
"""Weight of an angle relative to changes. Half and twice are no better (`make sensitivity`)."""
MIN_WEIGHT = 1e-6
"""Weight of an undefined angle. It guards a division where no frame defines the angle."""
MIN_PALM_M, FULL_PALM_M = 0.02, 0.05
"""Distances (m) from wrist to palm between which the weight of the direction rises from 0 to 1.
The first guards against palms too short to have one (`test_impossible_palm_is_ignored`)."""
MAX_PALM_FLEXION, FULL_PALM_FLEXION = np.radians([100.0, 70.0])
"""Palm flexions (radians) at which observations are rejected, and up to which accepted."""


class Limb(NamedTuple):
    """Joints of an arm or a leg."""

    upper: int
    lower: int
    end: int
    flexion_direction: tuple[float, float, float]
    role: str = ""
    """Role of the upper joint."""


class ExpectedTwists(NamedTuple):
    """Axial rotations of similar library poses, as complex numbers; the length is their
    certainty.

    Attributes
    ----------
    twists : complex, shape (n_frames,)
    weights : shape (n_frames,)
        Weights relative to a flexed limb.
    """

    twists: Complex
    weights: Array


class HingeAxes(NamedTuple):
    """Hinge axes of elbow or knee from similar library poses.

    Attributes
    ----------
    vectors : shape (n_frames, 3), optional
        In the world; the length is their certainty. None without a library.
    ignore_flexion : bool
        Whether to use only these, frame by frame; unknown hinges then mean zero axial
        rotation.
    """

    vectors: Array | None = None
    ignore_flexion: bool = False


UNKNOWN_HINGES = HingeAxes()


def rotations_from_flexion(
    rotations: Array,
    limb: Limb,
    skeleton: Skeleton,
    positions: Array,
    reliability: Array,
    frame_rate: float,
    hinges: HingeAxes = UNKNOWN_HINGES,
) -> Array:
    """Set the axial rotation of an upper arm or thigh from the flexion of its hinge.

    The axial rotation of a frame is a point on the unit circle. Observations are weighted by
    flexion, reliability and joint range. Least squares in the plane fits a smooth path to them
    and to the library's rotation, or to zero rotation without a library. Where the path passes
    near the center of the circle, its angle is interpolated.

    Parameters
    ----------
    rotations : shape (n_frames, 4)
        World rotations that aim the upper joint.
    limb : Limb
    skeleton : Skeleton
        In a T-pose.
    positions : shape (n_frames, n_joints, 3), meters
    reliability : shape (n_frames, n_joints), 0 to 1
    frame_rate : float, hertz
    hinges : HingeAxes

    Returns
    -------
    NDArray, shape (n_frames, 4)
        NaN where `rotations` are.
    """
    along = unit_vectors(skeleton.offsets[limb.lower])
    axis = rotate(rotations, along)
    hinge = rotate(rotations, unit_vectors(cross(along, np.array(limb.flexion_direction))))
    normal, flexion = measure_flexion(
        axis, unit_vectors(positions[:, limb.end] - positions[:, limb.lower])
    )
    limb_reliability = np.min(reliability[:, [limb.upper, limb.lower, limb.end]], axis=1)
    library_twists = np.zeros(len(rotations), np.complex128)
    if hinges.vectors is not None:
        library_twists = _angles_or_zero(axis, hinge, hinges.vectors) * np.linalg.norm(
            hinges.vectors, axis=-1
        )
    if hinges.ignore_flexion:
        return _rotate_about_axis(rotations, axis, np.angle(library_twists))
    expected = ExpectedTwists(
        library_twists, LIBRARY_WEIGHT + (REST_WEIGHT - LIBRARY_WEIGHT) * limb_reliability
    )
    return twist_to_normal(
        rotations,
        axis,
        hinge,
        normal,
        flexion_weights(flexion) * limb_reliability,
        frame_rate,
        expected,
    )


def flexion_weights(flexion: Array) -> Array:
    """Return the weights, 0 to 1 and same shape, of the planes of flexion angles, radians."""
    return np.asarray(np.clip((flexion - MIN_FLEXION) / (FULL_FLEXION - MIN_FLEXION), 0, 1))


def rotations_from_thumb(
    rotations: Array,
    along: Array,
    thumb: Array,
    observed: Array,
    reliability: Array,
    frame_rate: float,
) -> Array:
    """Set the axial rotation of a hand from the observed thumb, smoothed over time.

    Parameters
    ----------
    rotations : shape (n_frames, 4)
        World rotations that aim the hand.
    along, thumb : shape (3,)
        Offsets of hand and thumb in the rest pose.
    observed : shape (n_frames, 3)
        Observed offset of the thumb.
    reliability : shape (n_frames,), 0 to 1
    frame_rate : float, hertz
    """
    axis = rotate(rotations, unit_vectors(along))
    reference = rotate(rotations, unit_vectors(cross(along, thumb)))
    normal = cross(axis, unit_vectors(observed))
    return twist_to_normal(
        rotations,
        axis,
        reference,
        normal,
        reliability * np.linalg.norm(normal, axis=-1),
        frame_rate,
    )


def smooth_direction(
    observed: Array, above: Array, forward: Array, reliability: Array, frame_rate: float
) -> Array:
    """Return an offset with its direction smoothed over 0.1 s, weighted by reliability.

    A camera observes fingertips to a few centimeters, which on so short a bone is up to half a
    right angle. Smoothing is relative to the bone above; unreliable offsets continue its
    direction.

    Parameters
    ----------
    observed : shape (n_frames, 3)
    above : shape (n_frames, 4)
        World rotations of the joint above.
    forward : shape (3,)
        The bone above in the rest pose.
    reliability : shape (n_frames,), 0 to 1
    frame_rate : float, hertz
    """
    local = rotate(inverse(above), unit_vectors(observed))
    is_known = np.isfinite(local).all(axis=-1)
    weights = np.where(is_known, reliability * _palm_weights(observed, local, forward), 0.0)
    weighted = weights[:, None] * np.where(
        is_known[:, None], local, 0.0
    ) + REST_WEIGHT * unit_vectors(forward)
    smooth = unit_vectors(
        solve_smooth_paths(weighted, weights + REST_WEIGHT, (TWIST_TIME_S * frame_rate) ** 2)
    )
    lengths = np.linalg.norm(observed, axis=-1, keepdims=True)
    return np.asarray(rotate(above, smooth) * lengths)


def _palm_weights(observed: Array, local: Array, forward: Array) -> Array:
    """Return 0 for offsets too short or too strongly flexed for a palm, up to 1 for others."""
    length = np.linalg.norm(observed, axis=-1)
    flexion = np.arccos(np.clip(local @ unit_vectors(forward), -1.0, 1.0))
    length_weights = np.clip((length - MIN_PALM_M) / (FULL_PALM_M - MIN_PALM_M), 0.0, 1.0)
    return np.asarray(
        length_weights
        * np.clip((MAX_PALM_FLEXION - flexion) / (MAX_PALM_FLEXION - FULL_PALM_FLEXION), 0, 1)
    )


def twist_to_normal(
    rotations: Array,
    axis: Array,
    reference: Array,
    normal: Array,
    weights: Array,
    frame_rate: float,
    expected: ExpectedTwists | None = None,
) -> Array:
    """Rotate frames about `axis` until `reference` reaches `normal`, with weights and
    smoothing.

    Arrays of shape (n_frames, 3) are in the world; `weights` has shape (n_frames,). Where
    `expected` is uncertain, the expected rotation is zero.
    """
    observed = _angles_or_zero(axis, reference, normal)
    weights = np.where(observed != 0.0, weights * (0.5 + 0.5 * observed.real), 0.0)
    stiffness = (TWIST_TIME_S * frame_rate) ** 2
    weighted, totals = weights * observed + REST_WEIGHT, weights + REST_WEIGHT
    if expected is not None:
        library_twists = _remove_actor_bias(expected.twists, observed, weights, frame_rate)
        certainty = np.abs(library_twists)
        weighted += expected.weights * library_twists - REST_WEIGHT * certainty
        totals += (expected.weights - REST_WEIGHT) * certainty
    solution = solve_smooth_paths(
        np.stack([weighted.real, weighted.imag], -1), totals, stiffness
    )
    path = np.asarray(solution[:, 0] + 1j * solution[:, 1])
    return _rotate_about_axis(rotations, axis, _smooth_angles(path, stiffness))


def _remove_actor_bias(
    library_twists: Complex, observed: Complex, weights: Array, frame_rate: float
) -> Complex:
    """Rotate the library's twist by the actor's mean deviation in flexed frames."""
    bias = ACTOR_BIAS_S * frame_rate + np.sum(weights * observed * np.conj(library_twists))
    return np.asarray(library_twists * bias / max(abs(bias), MIN_WEIGHT))


def _angles_or_zero(directions: Array, plain: Array, hinges: Array) -> Complex:
    """Return `axial_angles`; 0 where unknown."""
    return np.nan_to_num(axial_angles(directions, plain, hinges))


def _rotate_about_axis(rotations: Array, axis: Array, angles: Array) -> Array:
    return multiply(quaternion_from_rotation_vector(angles[:, None] * axis), rotations)


def _smooth_angles(path: Complex, stiffness: float) -> Array:
    """Return the angles of a path in the plane, radians, shape (n_frames,).

    Where the path passes near 0, an angle may change by half a turn within a frame. Such angles
    get a low weight, and the path is smoothed across them.
    """
    weights = AGREED_WEIGHT * np.abs(path) ** 4 + MIN_WEIGHT
    weighted = weights * np.unwrap(np.angle(path))
    return solve_smooth_paths(weighted[:, None], weights, stiffness)[:, 0]


def solve_smooth_paths(weighted: Array, weights: Array, stiffness: float) -> Array:
    """Solve (W + s D'D) z = weighted for paths z, shape (n_frames, n)."""
    n_frames = len(weighted)
    if n_frames == 1:
        return np.asarray(weighted / weights[:, None])
    ends = np.full(n_frames, 2.0)
    ends[0] -= 1.0
    ends[-1] -= 1.0
    bands = np.zeros((2, n_frames))
    bands[0, 1:] = -stiffness
    bands[1] = weights + stiffness * ends
    return np.asarray(scipy.linalg.solveh_banded(bands, weighted))
