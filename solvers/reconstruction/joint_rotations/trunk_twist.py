"""How far upper arms and thighs are twisted about themselves against the trunk.

Told without any rig: by the axis that elbow or knee turns about, against where it would be if
the limb had come the short way from the T-pose of the trunk. So it is the same number for all
makers and sizes, and needs no more than joints to be laid on another body.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...motion.humanoid import POSTURE_JOINTS
from .library_body import bone_frames
from .limb_angles import MIN_LENGTH, Complex, measure_flexion, unit_vectors
from .limb_twist import HINGES, HingeAxes

Array = NDArray[np.float64]

MIN_RELIABILITY = 1e-3
"""What a joint counts for at least, lest no neighbour is nearer than another."""
HALF_WEIGHT_M = 0.05
"""Metres from the nearest posture, as a root mean square over joints, at which half of its
twist counts."""


class TwistedLimb(NamedTuple):
    """A limb whose twist is told; places in `POSTURE_JOINTS`, directions of a T-pose."""

    upper: int
    lower: int
    end: int
    along: tuple[float, float, float]
    bends_towards: tuple[float, float, float]

    @property
    def hinge(self) -> Array:
        """Axis of elbow or knee in a T-pose that faces -Y."""
        return np.asarray(np.cross(self.along, self.bends_towards), dtype=np.float64)


def _limb(side: str, sign: float, upper: str, lower: str, end: str) -> TwistedLimb:
    places = [POSTURE_JOINTS.index(f"{side}{part}") for part in (upper, lower, end)]
    kind = upper[-3:]
    along = (sign, 0.0, 0.0) if kind == "Arm" else (0.0, 0.0, -1.0)
    return TwistedLimb(places[0], places[1], places[2], along, HINGES[kind])


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
    """How limbs are twisted, as like postures have it.

    Attributes
    ----------
    vectors : complex, shape (n_frames, 4)
        Points in the unit circle, one for each of `TWISTED`: the angle is the twist, the length
        how far all agree; 0: nothing is known.
    alone : bool
        Whether these alone tell the twist [SHJT13, section VII-B], whatever elbows and knees
        show. Where nothing is known, limbs are then not twisted at all; to hold the twist that
        was known last measured worse.
    """

    vectors: Complex
    alone: bool = False


def untwisted_hinges(postures: Array) -> tuple[Array, Array]:
    """Return directions of limbs, and where hinges point in limbs that are not twisted.

    Parameters
    ----------
    postures : shape (n_frames, 20, 3), metres
        In any place and heading; NaN: not known.

    Returns
    -------
    directions, hinges : shape (n_frames, 4, 3)
        Unit vectors; NaN where the limb or the trunk is not known.
    """
    frames = bone_frames(postures)
    directions = np.empty((len(postures), N_TWISTED_LIMBS, 3))
    hinges = np.empty_like(directions)
    for place, limb in enumerate(TWISTED_LIMBS):
        way = unit_vectors(postures[:, limb.lower] - postures[:, limb.upper], np.nan)
        frame = frames[limb.upper]
        local = np.einsum("fji,fj->fi", frame, way)
        along, hinge = np.array(limb.along), limb.hinge
        # The short turn from `along` to `local` takes what is square to `along` there.
        share = (local @ hinge) / np.maximum(1.0 + local @ along, MIN_LENGTH)
        turned = hinge - share[:, None] * (along + local)
        directions[:, place] = way
        hinges[:, place] = unit_vectors(np.einsum("fij,fj->fi", frame, turned), np.nan)
    return directions, hinges


def flexion_normals(postures: Array) -> tuple[Array, Array]:
    """Return the axes about which elbows and knees are bent, and by how much.

    Returns
    -------
    normals : shape (n_frames, 4, 3)
    bends : shape (n_frames, 4), radians
    """
    ways = [
        [unit_vectors(postures[:, one] - postures[:, above], np.nan) for above, one in pairs]
        for pairs in (((x.upper, x.lower), (x.lower, x.end)) for x in TWISTED_LIMBS)
    ]
    first, second = (np.stack(each, axis=1) for each in zip(*ways, strict=True))
    return measure_flexion(first, second)


def hinges_from_twists(postures: Array, twists: LimbTwists) -> dict[str, HingeAxes]:
    """Return where twisted limbs have their hinges, by the roles of their upper joints.

    Parameters
    ----------
    postures : shape (n_frames, 20, 3), metres
        In the world.
    twists : LimbTwists
    """
    directions, plain = untwisted_hinges(postures)
    aside = np.cross(directions, plain)
    cos, sin = twists.vectors.real[..., None], twists.vectors.imag[..., None]
    ways = np.nan_to_num(cos * plain + sin * aside)
    return {
        POSTURE_JOINTS[limb.upper]: HingeAxes(ways[:, place], twists.alone)
        for place, limb in enumerate(TWISTED_LIMBS)
    }


def mirror_twists(twists: Complex) -> Complex:
    """Return twists of limbs, (..., 4), as a mirror shows them."""
    return np.asarray(np.conj(twists[..., list(OTHER_SIDE)]))


def mean_twists(twists: Complex, postures: Array, neighbours: Array, trust: Array) -> Complex:
    """Return the mean of neighbours' twists, weighted by their nearness [SHJT13, VII-B].

    The weight is the inverse of eq. 9, squared. The farther the nearest is, the shorter the
    mean.

    Parameters
    ----------
    twists : shape (n_frames, n_neighbours, 4)
    postures : shape (n_frames, 20, 3), metres
        As they were synthesised.
    neighbours : shape (n_frames, n_neighbours, 60), metres
    trust : shape (n_frames, 20)

    Returns
    -------
    shape (n_frames, 4)
    """
    off = neighbours - postures.reshape(len(postures), 1, -1)
    counted = np.repeat(np.maximum(trust, MIN_RELIABILITY), 3, axis=1)
    squares = np.einsum("fni,fni,fi->fn", off, off, counted, optimize=False)
    weights = 1.0 / np.maximum(squares, MIN_LENGTH)
    weights /= weights.sum(axis=1, keepdims=True)
    least_square = 3.0 * squares.min(axis=1) / counted.sum(axis=1)
    near = 1.0 / (1.0 + least_square / HALF_WEIGHT_M**2)
    return np.asarray(near[:, None] * np.einsum("fn,fnl->fl", weights, twists))
