"""Estimate the up axis of markers whose file does not state it."""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array
from .contact import measure_contact, sampled_steps
from .marker_bodies import direction_of_named_markers

CONTACT_WEIGHT = 1.0
"""Weight of the evidence of contact: the lowest markers rest, 0 to 1. By definition 1: the
others are relative to it."""
MAX_CONTACT = 0.5
"""Evidence of contact that is enough, a ratio. Chosen by hand: who walks has 0.3 to 0.5; the
trunk of who sits is still, so that there is 0.98 along a wrong axis in `markers.trc`."""
FLOOR_WEIGHT = 0.6
"""Weight of the evidence of the floor: the lowest marker is near zero, -1 to 1. Chosen by hand:
of 65 files of makers in two axes, x0.5 is wrong in 3 instead of 1 with names."""
EXTENT_WEIGHT = 0.5
"""Weight of the evidence of the extent: the body is long along the axis, 0 to 1. Chosen by
hand: of 332 cuts of HDM05 and CMU, x2 is wrong in more of those who lie."""
STANDING_WEIGHT = 1.0
"""Weight of the evidence of names in place of the extent: the head is above the feet, -1 to 1.
Chosen by hand, twice `EXTENT_WEIGHT`: a body is long whether it stands or spreads its arms."""
MAX_FLOOR_FRACTION = 0.4
"""Height of the lowest marker, relative to the body, that is no evidence of the floor. Chosen
by hand, as for joints (`standing_joints`)."""
CLEAR_LEAD = 0.3
"""Lead, in the weights above, of one axis over the other from which the estimate is certain.
Chosen by hand: of 664 upright cuts of HDM05 and CMU, 2 are wrong above, and 3 right below."""
AXES = ("+Y", "+Z")
DIRECTIONS = np.eye(3)[1:]


@np.errstate(over="ignore", invalid="ignore")  # numbers that are refused later
def estimate_up_of_markers(points: Array, labels: Sequence[str] = ()) -> tuple[str, float]:
    """Return whether Y or Z is up, and the confidence from 0.5 to 1.

    Three kinds of evidence are weighed against each other: whether the lowest markers rest
    (`measure_contact`), whether they are near zero, and whether the body stands.

    Parameters
    ----------
    points : shape (n_frames, n_points, 3), meters; NaN where missing
    labels : names in the file
    """
    is_observed = np.isfinite(points).all(axis=2).any(axis=1)
    steps, observed = sampled_steps(is_observed), points[is_observed]
    contact = measure_contact(points[steps], points[steps + 1], DIRECTIONS)
    totals = (
        CONTACT_WEIGHT * np.minimum(contact, MAX_CONTACT)
        + FLOOR_WEIGHT * _measure_floor(observed)
        + _weigh_posture(observed, labels)
    )
    y, z = totals.tolist()
    confidence = 0.5 + 0.5 * min(1.0, abs(y - z) / CLEAR_LEAD)
    return AXES[int(z >= y)], confidence


def _measure_floor(points: Array) -> Array:
    """Return how near the lowest marker is to zero along each axis, -1 to 1.

    It is negative only where zero is inside of the body, since none crosses a floor: markers
    may be on the upper body only, and what is all below zero has another origin.
    """
    lowest = np.percentile(np.nanmin(points, axis=1) @ DIRECTIONS.T, 5, axis=0)
    highest = np.percentile(np.nanmax(points, axis=1) @ DIRECTIONS.T, 95, axis=0)
    level = lowest / (MAX_FLOOR_FRACTION * _size(points))
    above, inside = np.maximum(1.0 - level, 0.0), np.maximum(1.0 + 2.0 * level, -1.0)
    return np.where(level > 0.0, above, np.where(highest > 0.0, inside, 0.0))


def _weigh_posture(points: Array, labels: Sequence[str]) -> Array:
    standing = direction_of_named_markers(labels, points)
    if standing is not None:
        return STANDING_WEIGHT * DIRECTIONS @ standing
    return EXTENT_WEIGHT * DIRECTIONS @ _extents(points) / _size(points)


def _extents(points: Array) -> Array:
    """Return the size of the bounding box in most frames, shape (3,)."""
    return np.asarray(np.median(np.nanmax(points, axis=1) - np.nanmin(points, axis=1), axis=0))


def _size(points: Array) -> float:
    return max(float(_extents(points).max()), 1e-9)
