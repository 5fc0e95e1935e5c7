"""Keep knees as straight as the source's where its legs were measured unequally long."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


class Leg(NamedTuple):
    """One leg of the target, and what the source's looks like."""

    hip: Array
    """Where the upper leg begins, shape (n_frames, 3), metres."""
    ankle: Array
    """Where the ankle is to be, shape (n_frames, 3), metres."""
    distance: Array
    """From hip to ankle if the knee were as straight as the source's, shape (n_frames,)."""
    stands: Flags
    """Shape (n_frames,)."""
    excess: float
    """By how much the source's leg is longer than the mean of both, grown, metres."""


def level_ankles(left: Leg, right: Leg) -> list[Array]:
    """Return other places of the left and right ankle, shape (n_frames, 3), metres.

    Sensors measure one leg a little shorter than the other, so that its foot never comes as far
    down; legs of equal length would bend that knee by 20 degrees for two per cent. The ankle of
    the shorter leg comes down and the other's up until standing knees are as straight as the
    source's, but by no more than the legs differ. It is the same in all frames: no foot slides.
    """
    if not (left.stands.any() and right.stands.any()):
        return [left.ankle, right.ankle]
    wanted = 0.5 * (_lacking_height(left) - _lacking_height(right))
    raised = min(max(wanted, min(left.excess, 0.0)), max(left.excess, 0.0))
    shift = np.array([0.0, 0.0, raised])
    return [left.ankle + shift, right.ankle - shift]


def _lacking_height(leg: Leg) -> float:
    """Return by how much the standing ankle ought to be higher, metres."""
    way = leg.ankle - leg.hip
    beside = (way[:, :2] ** 2).sum(axis=1)
    height = -np.sqrt(np.maximum(leg.distance**2 - beside, 0.0))
    return float(np.median((height - way[:, 2])[leg.stands]))
