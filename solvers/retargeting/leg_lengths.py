"""Keep knees as straight as the source's if its legs were measured with unequal lengths."""

from typing import NamedTuple

import numpy as np

from ..arrays import Array, Flags


class TargetLeg(NamedTuple):
    """One leg of the target, with the extension and contacts of the source's."""

    hip: Array
    """Start of the upper leg, shape (n_frames, 3), meters."""
    ankle: Array
    """Target position of the ankle, shape (n_frames, 3), meters."""
    distance: Array
    """Distance from hip to ankle with the knee as straight as the source's, (n_frames,)."""
    in_contact: Flags
    """Whether the foot is in contact, shape (n_frames,)."""
    excess: float
    """Length of the source's leg minus the mean of both, scaled, meters."""


def level_ankles(left: TargetLeg, right: TargetLeg) -> list[Array]:
    """Return corrected positions of the left and right ankle, shape (n_frames, 3), meters.

    Sensors measure one leg a little shorter than the other, so that its foot stays higher. On
    legs of equal length, two percent of difference flex that knee by 20 degrees. The ankle of
    the shorter leg is lowered and the other one raised until standing knees are as straight as
    the source's, but at most by the difference of the legs. The correction is constant over
    time, so that no foot slides.
    """
    if not (left.in_contact.any() and right.in_contact.any()):
        return [left.ankle, right.ankle]
    difference = 0.5 * (_missing_height(left) - _missing_height(right))
    lift = min(max(difference, min(left.excess, 0.0)), max(left.excess, 0.0))
    shift = np.array([0.0, 0.0, lift])
    return [left.ankle + shift, right.ankle - shift]


def _missing_height(leg: TargetLeg) -> float:
    """Return the correction of height that the standing ankle needs, meters."""
    leg_vector = leg.ankle - leg.hip
    horizontal_square = (leg_vector[:, :2] ** 2).sum(axis=1)
    height = -np.sqrt(np.maximum(leg.distance**2 - horizontal_square, 0.0))
    return float(np.median((height - leg_vector[:, 2])[leg.in_contact]))
