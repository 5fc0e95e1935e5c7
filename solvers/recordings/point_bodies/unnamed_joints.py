"""Name the joints of an array without names, by the body that they form."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...motion import Tracks
from ...motion.humanoid import (
    ADULT_BONE_LENGTHS_M,
    MIRROR_JOINTS,
    POSTURE_JOINTS,
    SIDES,
    posture_positions,
    segment_lengths,
)
from ...motion.skeletons import COMPUTED_JOINTS, LAYOUTS

N_SAMPLED_FRAMES = 200
"""Number of frames, evenly spaced, whose bones are measured. It bounds the run time."""
MAX_MISFIT = 0.65
"""Misfit, a ratio (`bone_misfit`), from which points do not form a body in that order. Measured
on takes of CMU and HDM05: the right order has 0.1 to 0.3, and 0.3 to 0.6 with noise of 2 cm;
one in a hundred random orders has less than 0.73; x0.5 and x2 fail tests of this module."""
MIN_MISFIT_OF_OTHERS = 1.2
"""Misfit, a ratio, from which points are no body even in an order that is expected. Chosen by
hand: twice that of a take with noise of 2 cm, and the least of 20 arrays of pure noise."""
CLEAR_MISFIT = 0.35
"""Misfit, a ratio, up to which the confidence is full. Measured on the same takes."""
CLEAR_LEAD = 1.5
"""Misfit of the next order relative to the best, from which the confidence is full. Measured:
it is 1.7 and more on those takes."""
MAX_BONE_MISFIT = 1.0
"""Misfit of one bone, a ratio, that counts. It guards against single points that are wrong."""
MAX_INWARD = 0.8
"""Cosine between a thigh and the direction to the other hip, from which points form no body.
Measured: its median is at most 0.53 in 183 takes of five sensors, CMU, HDM05 and other makers;
of points in rows, such as those of a calibration board, it is 1."""
LIMB_BONES = [
    POSTURE_JOINTS.index(side + part)
    for side in SIDES
    for part in ("UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot")
]
"""Joints at the lower ends of bones that every order has."""
OTHER_SIDE = [MIRROR_JOINTS[joint] for joint in LIMB_BONES]


class NamedJoints(NamedTuple):
    """Points of an array with the names that they have in one order of joints."""

    layout: str
    """A key of `LAYOUTS`."""
    names: tuple[str, ...]
    positions: Array
    """Shape (n_frames, n_joints, 3), in the unit and axes of the file."""
    confidence: float
    """From 0.5, barely a body or two orders that fit equally well, to 1."""


def has_layout(n_points: int) -> bool:
    """Return whether a known order of joints has this many points."""
    return any(len(order) == n_points for order in LAYOUTS.values())


def name_joints(points: Array) -> NamedJoints | None:
    """Return the joints by name, or None if they form no body in any known order.

    In the right order the bones keep their lengths, those of both sides are equal, and their
    proportions are human. The order with the smallest misfit of all three is chosen.

    Parameters
    ----------
    points : shape (n_frames, n_points, 3)
        In any unit and axes; NaN where missing.
    """
    step = max(1, len(points) // N_SAMPLED_FRAMES)
    misfits = {
        layout: bone_misfit(*_in_order(points[::step], order))
        for layout, order in LAYOUTS.items()
        if len(order) == points.shape[1]
    }
    ranked = sorted(misfits, key=lambda layout: misfits[layout])
    if not ranked or not misfits[ranked[0]] < MAX_MISFIT:
        return None
    best = misfits[ranked[0]]
    lead = min((misfits[other] for other in ranked[1:]), default=np.inf) / max(best, 1e-9)
    fits = min((MAX_MISFIT - best) / (MAX_MISFIT - CLEAR_MISFIT), 1.0)
    leads = min((lead - 1.0) / (CLEAR_LEAD - 1.0), 1.0)
    named = _in_order(points, LAYOUTS[ranked[0]])
    return NamedJoints(ranked[0], *named, 0.5 + 0.5 * fits * leads)


def is_no_body(points: Array, order: Sequence[str]) -> bool:
    """Return whether points, (F, n, 3), in an order of joints cannot be those of a body.

    It takes more than for `name_joints`, and nothing follows from joints that are missing: the
    order is expected, and points of cameras may be noisy, or the upper body alone.
    """
    step = max(1, len(points) // N_SAMPLED_FRAMES)
    posture = posture_positions(Tracks(*_in_order(points[::step], order), 1.0))
    lengths, is_known = limb_lengths(posture)
    is_odd = is_known.all() and length_misfit(lengths) > MIN_MISFIT_OF_OTHERS
    return bool(is_odd) or _is_crossed(posture) or _has_thigh_inward(posture)


def bone_misfit(names: Sequence[str], positions: Array) -> float:
    """Return how far joints, (F, n, 3), are from a body: 0 for an adult with rigid bones.

    It is the sum of three means over the bones of the limbs, each a ratio: the spread of the
    length over time, the difference of both sides, and the difference from an adult's
    proportions. It is infinite if one order of the sides is that of the hips, and the other one
    that of the shoulders, or if a thigh crosses the other one.
    """
    posture = posture_positions(Tracks(tuple(names), positions, 1.0))
    lengths, is_known = limb_lengths(posture)
    is_body = is_known.all() and not _is_crossed(posture) and not _has_thigh_inward(posture)
    return length_misfit(lengths) if is_body else np.inf


def limb_lengths(posture: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return the lengths of the bones of one side, then of the other, and which are known.

    Shapes (n_frames, 2 n) and (n,). Lengths are NaN where both joints are at one point, as
    where a tracker writes zeros.
    """
    lengths = segment_lengths(posture)[:, [*LIMB_BONES, *OTHER_SIDE]]
    lengths = np.where(lengths > 0.0, lengths, np.nan)
    is_known = np.isfinite(lengths).any(axis=0).reshape(2, -1).all(axis=0)
    return lengths, np.asarray(is_known)


def length_misfit(lengths: Array, is_known: NDArray[np.bool_] | None = None) -> float:
    """Return how far the lengths of bones are from those of a body (`bone_misfit`).

    Parameters
    ----------
    lengths : shape (n_frames, 2 n)
        Of the bones of one side, then of the other; NaN where missing, but not in all frames.
    is_known : shape (len(LIMB_BONES),), or None
        Which bones these are; None: all.
    """
    low, typical, high = np.nanpercentile(lengths, [10.0, 50.0, 90.0], axis=0)
    one, other = np.split(np.log(typical), 2)
    adult = ADULT_BONE_LENGTHS_M[LIMB_BONES]
    ratios = one - np.log(adult if is_known is None else adult[is_known])
    parts = (
        ((high - low) / typical)[: len(one)],
        np.abs(one - other),
        np.abs(ratios - np.median(ratios)),
    )
    return float(sum(np.minimum(part, MAX_BONE_MISFIT).mean() for part in parts))


def _is_crossed(posture: Array) -> bool:
    """Return whether left is on one side in the hips and on the other one in the shoulders."""
    hips, shoulders = (
        posture[:, POSTURE_JOINTS.index(f"left{part}")]
        - posture[:, POSTURE_JOINTS.index(f"right{part}")]
        for part in ("UpperLeg", "UpperArm")
    )
    agreement = (hips * shoulders).sum(axis=1)
    return bool(np.isfinite(agreement).any() and np.nanmedian(agreement) < 0.0)


def _has_thigh_inward(posture: Array) -> bool:
    """Return whether the thigh of a side points to the other side in most frames."""
    hips, knees = (
        np.stack([posture[:, POSTURE_JOINTS.index(f"{side}{part}")] for side in SIDES])
        for part in ("UpperLeg", "LowerLeg")
    )
    thighs, across = knees - hips, hips[::-1] - hips
    lengths = np.linalg.norm(thighs, axis=-1) * np.linalg.norm(across, axis=-1)
    along = (thighs * across).sum(axis=-1)
    inward = np.divide(along, lengths, out=np.full_like(along, np.nan), where=lengths > 0.0)
    return any(
        np.median(side[np.isfinite(side)]) > MAX_INWARD
        for side in inward
        if np.isfinite(side).any()
    )


def _in_order(points: Array, order: Sequence[str]) -> tuple[tuple[str, ...], Array]:
    """Return the named points, with the joints in the middle of the body that are missing."""
    names = [name for name in order if name]
    columns = [points[:, order.index(name)] for name in names]
    computed = {} if "pelvis" in names else COMPUTED_JOINTS
    for center, sides in computed.items():
        if center not in names and set(sides) <= set(names):
            columns.append(np.mean([columns[names.index(side)] for side in sides], axis=0))
            names.append(center)
    return tuple(names), np.stack(columns, axis=1)
