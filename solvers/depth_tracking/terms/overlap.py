"""Limbs cannot be inside each other: capsules that overlap push each other apart."""

import numpy as np
from numpy.typing import NDArray

from ..body import CAPSULE_SEGMENTS, CAPSULES, SIDES, Integers, SurfaceRows
from .hypothesis import Hypothesis

Array = NDArray[np.float64]

RADIUS_FRACTION = 0.85
"""Share of the radii that counts: clothes and flesh give way."""


def _pairs() -> tuple[Integers, Integers]:
    legs = [f"{side}{part}" for side in SIDES for part in ("UpperLeg", "LowerLeg", "Foot")]
    arms = [f"{side}{part}" for side in SIDES for part in ("LowerArm", "Hand")]
    left = [name for name in legs if name.startswith("left")]
    pairs = [(a, b) for a in left for b in legs if b.startswith("right")]
    pairs += [(a, b) for a in arms for b in ("chest", "spine", "hips", "head")]
    pairs += [(a, f"{side}UpperLeg") for a in arms for side in SIDES]
    pairs += [
        (f"left{a}", f"right{b}") for a in ("LowerArm", "Hand") for b in ("LowerArm", "Hand")
    ]
    places = np.array([[CAPSULES.index(a), CAPSULES.index(b)] for a, b in pairs])
    return places[:, 0].astype(np.intp), places[:, 1].astype(np.intp)


_FIRST, _SECOND = _pairs()


def separation_term(hypothesis: Hypothesis, weight: float) -> SurfaceRows:
    """Return rows that push overlapping limbs apart, half the way each.

    Elliptic capsules count as round ones of their smaller radius.

    Parameters
    ----------
    hypothesis : Hypothesis
    weight : float, per square metre
        Of one pair.
    """
    body, frames = hypothesis.body, hypothesis.frames[CAPSULE_SEGMENTS]
    ends = np.einsum("nij,nej->nei", frames[:, :3, :3], body.capsule_ends)
    ends += frames[:, np.newaxis, :3, 3]
    radii = RADIUS_FRACTION * body.radii.min(axis=1)
    near, far = _closest(ends[_FIRST], ends[_SECOND])
    between = near - far
    distances = np.sqrt(np.einsum("ni,ni->n", between, between))
    overlap = radii[_FIRST] + radii[_SECOND] - distances
    deep = np.flatnonzero(overlap > 0.0)
    away = between[deep] / np.maximum(distances[deep], 1e-6)[:, np.newaxis]
    return SurfaceRows(
        np.concatenate([near[deep], far[deep]]), np.concatenate([away, -away]),
        0.5 * np.tile(overlap[deep], 2), np.full(2 * len(deep), weight),
        np.concatenate([_FIRST[deep], _SECOND[deep]]),
    )  # fmt: skip


def _closest(first: Array, second: Array) -> tuple[Array, Array]:
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
    slant = np.maximum(a * e - b * b, 1e-12)
    s = np.clip((b * f - c * e) / slant, 0.0, 1.0)
    t = np.clip((b * s + f) / e, 0.0, 1.0)
    s = np.clip((b * t - c) / a, 0.0, 1.0)
    return first[:, 0] + s[:, np.newaxis] * along, second[:, 0] + t[:, np.newaxis] * across
