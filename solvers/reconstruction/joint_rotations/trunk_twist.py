"""Axial rotation of upper arms and thighs relative to the trunk.

The angle is measured from the hinge axis of elbow or knee to the axis after the shortest
rotation of the limb from the trunk's T-pose. It depends only on joint positions, not on the rig
or body size, so it transfers to other bodies.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ...motion.humanoid import POSTURE_JOINTS
from ...rotations import cross
from .library_body import bone_frames
from .limb_angles import MIN_LENGTH, Complex, measure_flexion, unit_vectors
from .limb_twist import HINGES, HingeAxes


class TwistedLimb(NamedTuple):
    """A limb with an axial rotation; indices into `POSTURE_JOINTS`, directions of a T-pose."""

    upper: int
    lower: int
    end: int
    along: tuple[float, float, float]
    flexion_direction: tuple[float, float, float]

    @property
    def hinge(self) -> Array:
        """Axis of elbow or knee in a T-pose that faces -Y."""
        return cross(np.array(self.along), np.array(self.flexion_direction))


def _limb(side: str, sign: float, upper: str, lower: str, end: str) -> TwistedLimb:
    indices = [POSTURE_JOINTS.index(f"{side}{part}") for part in (upper, lower, end)]
    kind = upper[-3:]
    along = (sign, 0.0, 0.0) if kind == "Arm" else (0.0, 0.0, -1.0)
    return TwistedLimb(indices[0], indices[1], indices[2], along, HINGES[kind])


TWISTED_LIMBS = tuple(
    _limb(side, sign, *parts)
    for parts in (("UpperArm", "LowerArm", "Hand"), ("UpperLeg", "LowerLeg", "Foot"))
    for side, sign in (("left", 1.0), ("right", -1.0))
)
"""Left and right arm, left and right leg."""
N_TWISTED_LIMBS = len(TWISTED_LIMBS)
OTHER_SIDE = (1, 0, 3, 2)


@dataclass(frozen=True, eq=False)
class LimbTwists:
    """Axial rotations of limbs from similar library poses.

    Attributes
    ----------
    vectors : complex, shape (n_frames, 4)
        Points in the unit circle, one for each of `TWISTED_LIMBS`: the angle is the twist,
        the length its certainty; 0: unknown.
    ignore_flexion : bool
        Whether to use these alone [SHJT13, section VII-B] and ignore the flexion of elbows
        and knees. Unknown twists are then zero; holding the last known twist measured
        worse.
    """

    vectors: Complex
    ignore_flexion: bool = False


def untwisted_hinges(postures: Array) -> tuple[Array, Array]:
    """Return directions of limbs, and hinge axes of limbs without axial rotation.

    Parameters
    ----------
    postures : shape (n_frames, 20, 3), meters
        At any position and heading; NaN: unknown.

    Returns
    -------
    directions, hinges : shape (n_frames, 4, 3)
        Unit vectors; NaN where the limb or the trunk is unknown.
    """
    frames = bone_frames(postures)
    directions = np.empty((len(postures), N_TWISTED_LIMBS, 3))
    hinges = np.empty_like(directions)
    for index, limb in enumerate(TWISTED_LIMBS):
        direction = unit_vectors(postures[:, limb.lower] - postures[:, limb.upper], np.nan)
        frame = frames[limb.upper]
        local = np.einsum("fji,fj->fi", frame, direction)
        along, hinge = np.array(limb.along), limb.hinge
        # The shortest rotation from `along` to `local`, applied to the perpendicular hinge.
        fraction = (local @ hinge) / np.maximum(1.0 + local @ along, MIN_LENGTH)
        swung = hinge - fraction[:, None] * (along + local)
        directions[:, index] = direction
        hinges[:, index] = unit_vectors(np.einsum("fij,fj->fi", frame, swung), np.nan)
    return directions, hinges


def flexion_normals(postures: Array) -> tuple[Array, Array]:
    """Return flexion axes and flexion angles of elbows and knees.

    Returns
    -------
    normals : shape (n_frames, 4, 3)
    bends : shape (n_frames, 4), radians
    """
    axes = [
        [unit_vectors(postures[:, one] - postures[:, above], np.nan) for above, one in pairs]
        for pairs in (((x.upper, x.lower), (x.lower, x.end)) for x in TWISTED_LIMBS)
    ]
    first, second = (np.stack(each, axis=1) for each in zip(*axes, strict=True))
    return measure_flexion(first, second)


def hinges_from_twists(postures: Array, twists: LimbTwists) -> dict[str, HingeAxes]:
    """Return the hinge axes of twisted limbs, by the roles of their upper joints.

    Parameters
    ----------
    postures : shape (n_frames, 20, 3), meters
        In the world.
    twists : LimbTwists
    """
    directions, untwisted = untwisted_hinges(postures)
    perpendicular = cross(directions, untwisted)
    cos, sin = twists.vectors.real[..., None], twists.vectors.imag[..., None]
    axes = np.nan_to_num(cos * untwisted + sin * perpendicular)
    return {
        POSTURE_JOINTS[limb.upper]: HingeAxes(axes[:, index], twists.ignore_flexion)
        for index, limb in enumerate(TWISTED_LIMBS)
    }


def mirror_twists(twists: Complex) -> Complex:
    """Return the mirror image of axial rotations of limbs, (..., 4)."""
    return np.asarray(np.conj(twists[..., list(OTHER_SIDE)]))


def mean_twists(
    twists: Complex, postures: Array, neighbors: Array, reliability: Array
) -> Complex:
    """Return the mean twist of the neighbors, weighted by similarity [SHJT13, VII-B].

    The weight is the inverse of eq. 9, squared.

    Parameters
    ----------
    twists : shape (n_frames, n_neighbors, 4)
    postures : shape (n_frames, 20, 3), meters
        Synthesized poses.
    neighbors : shape (n_frames, n_neighbors, 60), meters
    reliability : shape (n_frames, 20)

    Returns
    -------
    shape (n_frames, 4)
    """
    differences = neighbors - postures.reshape(len(postures), 1, -1)
    joint_weights = np.repeat(reliability, 3, axis=1)
    squares = np.einsum(
        "fni,fni,fi->fn", differences, differences, joint_weights, optimize=False
    )
    weights = 1.0 / np.maximum(squares, MIN_LENGTH)
    weights /= weights.sum(axis=1, keepdims=True)
    return np.asarray(np.einsum("fn,fnl->fl", weights, twists))
