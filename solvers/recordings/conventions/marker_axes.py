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
"""Evidence of contact that is enough, a ratio. Measured: an actor who walks has 0.3 to 0.5; the
trunk of a sitting one is still, so that there is 0.98 along a wrong axis in `markers.trc`."""
FLOOR_WEIGHT = 0.8
"""Weight of the evidence of the floor: the lowest marker is near zero, 0 to 1. Sweep: of 692
cuts of HDM05 and CMU relative to the hips, 58 instead of 49 are wrong with x0.5, and 10 instead
of 5 without low confidence with x2."""
EXTENT_WEIGHT = 0.3
"""Weight of the evidence of the extent: the body is long along the axis, 0 to 1. Sweep: of the
same cuts, 61 are wrong with x0.5 and 69 with x2."""
STANDING_WEIGHT = 1.0
"""Weight of the evidence of names in place of the extent: the head is above the feet, -1 to 1.
Chosen by hand, above `EXTENT_WEIGHT`: a body is long whether it stands or spreads its arms."""
MAX_FLOOR_FRACTION = 0.4
"""Height of the lowest marker, relative to the body, that is no evidence of the floor. Chosen
by hand, as for joints (`standing_joints`): markers may be on the upper body only."""
MAX_DEPTH_FRACTION = 0.1
"""The same below zero, since no marker is below a floor. Sweep: of 692 cuts relative to the
hips, x0.5 and x2 are wrong in 65 and 64 instead of 49."""
CLEAR_LEAD = 0.4
"""Lead, in the weights above, of one axis over the other from which the estimate is certain.
Measured: of 692 cuts on a floor, 4 are wrong above, and 23 right below."""
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
    """Return how near the lowest marker is to zero along each axis, 0 to 1.

    It is no evidence against an axis where zero is inside of the body: the origin may be at the
    camera or the hips.
    """
    lowest = np.percentile(np.nanmin(points, axis=1) @ DIRECTIONS.T, 5, axis=0)
    level = lowest / _size(points)
    limit = np.where(level > 0.0, MAX_FLOOR_FRACTION, MAX_DEPTH_FRACTION)
    return np.asarray(np.maximum(1.0 - np.abs(level) / limit, 0.0))


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
