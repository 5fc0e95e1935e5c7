"""The separation term: overlapping capsules push each other out."""

import numpy as np
from numpy.typing import NDArray

from ..body import CAPSULE_SEGMENTS, CAPSULES, SIDES, Integers, SurfaceRows
from .hypothesis import Hypothesis

Array = NDArray[np.float64]

RADIUS_FRACTION = 0.85
"""Fraction of the radii used, because clothes and flesh are soft."""


def _capsule_pairs() -> tuple[Integers, Integers]:
    legs = [f"{side}{part}" for side in SIDES for part in ("UpperLeg", "LowerLeg", "Foot")]
    arms = [f"{side}{part}" for side in SIDES for part in ("LowerArm", "Hand")]
    left = [name for name in legs if name.startswith("left")]
    pairs = [(a, b) for a in left for b in legs if b.startswith("right")]
    pairs += [(a, b) for a in arms for b in ("chest", "spine", "hips", "head")]
    pairs += [(a, f"{side}UpperLeg") for a in arms for side in SIDES]
    pairs += [
        (f"left{a}", f"right{b}") for a in ("LowerArm", "Hand") for b in ("LowerArm", "Hand")
    ]
    indices = np.array([[CAPSULES.index(a), CAPSULES.index(b)] for a, b in pairs])
    return indices[:, 0].astype(np.intp), indices[:, 1].astype(np.intp)


_FIRST, _SECOND = _capsule_pairs()


def separation_term(hypothesis: Hypothesis, weight: float) -> SurfaceRows:
    """Return rows that separate overlapping limbs, each by half the overlap.

    Elliptic capsules count as round, with their smaller radius.

    Parameters
    ----------
    hypothesis : Hypothesis
    weight : float, per square meter
        Weight of one pair.
    """
    body, frames = hypothesis.body, hypothesis.frames[CAPSULE_SEGMENTS]
    ends = np.einsum("nij,nej->nei", frames[:, :3, :3], body.capsule_ends)
    ends += frames[:, np.newaxis, :3, 3]
    radii = RADIUS_FRACTION * body.radii.min(axis=1)
    first_points, second_points = _closest_points(ends[_FIRST], ends[_SECOND])
    offsets = first_points - second_points
    distances = np.sqrt(np.einsum("ni,ni->n", offsets, offsets))
    overlap = radii[_FIRST] + radii[_SECOND] - distances
    overlapping = np.flatnonzero(overlap > 0.0)
    directions = offsets[overlapping] / np.maximum(distances[overlapping], 1e-6)[:, np.newaxis]
    return SurfaceRows(
        np.concatenate([first_points[overlapping], second_points[overlapping]]),
        np.concatenate([directions, -directions]),
        0.5 * np.tile(overlap[overlapping], 2), np.full(2 * len(overlapping), weight),
        np.concatenate([_FIRST[overlapping], _SECOND[overlapping]]),
    )  # fmt: skip


def _closest_points(first: Array, second: Array) -> tuple[Array, Array]:
    """Return the closest points of line segments (n, 2, 3), pair by pair [ERI04]_.

    References
    ----------
    .. [ERI04] Ericson (2004). Real-time collision detection, section 5.1.9.
    """
    along, across = first[:, 1] - first[:, 0], second[:, 1] - second[:, 0]
    offset = first[:, 0] - second[:, 0]
    a, e = (along**2).sum(axis=1), (across**2).sum(axis=1)
    b, c = (along * across).sum(axis=1), (along * offset).sum(axis=1)
    f = (across * offset).sum(axis=1)
    denominator = np.maximum(a * e - b * b, 1e-12)
    s = np.clip((b * f - c * e) / denominator, 0.0, 1.0)
    t = np.clip((b * s + f) / e, 0.0, 1.0)
    s = np.clip((b * t - c) / a, 0.0, 1.0)
    return first[:, 0] + s[:, np.newaxis] * along, second[:, 0] + t[:, np.newaxis] * across
