"""Retarget hands near the ground: match their height and keep them above it."""

from typing import NamedTuple

import numpy as np
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from ..arrays import Array
from ..signals import smooth_gaussian, smoothstep
from .placement import HipPlacement

LOW_WRIST_FRACTION, HIGH_WRIST_FRACTION = 0.2, 0.4
"""Heights of the wrist, as fractions of the leg length. Below the first, the height above
ground is the source's, scaled by the legs; above the second, the ground has no influence.
Chosen by hand: first, x0.5 costs 0.1 %, x2 gains 3.1 %; second, x0.5 gains 4.6 %, x2 gains
0.3 %."""
SUPPORT_HEIGHT_FRACTIONS = (0.12, 0.18)
"""The same heights, as fractions of the leg length, for hands that support themselves on the
ground. Chosen by hand: x0.5 costs nothing, x2 gains 0.1 %."""
SUPPORT_SPEED, PASSING_SPEED = 0.25, 1.0
"""Speeds in leg lengths per second: low hands slower than the first support themselves on the
ground; hands faster than the second only pass. They guard hands that sweep over the ground,
which would be pulled to the place of the source's."""
SPEED_SMOOTHING_S = 0.1
"""Standard deviation of the Gaussian that smooths the speed. It guards a hand that turns in a
sweep over the ground: it stands for an instant, as if it supported the body."""
SHIFT_SMOOTHING_S = 0.07
"""Standard deviation of the Gaussian that smooths the displacement of the hands. Chosen by
hand: x0.5 costs 4.2 %, x2 costs nothing."""
LIFT_EASE_S = 0.07
"""Seconds over which the lift of hands off the ground eases in and out. Chosen by hand: x0.5
costs 0.2 %, x2 costs nothing."""
EASE_EXTENSION_FRACTION = 0.9
"""Fraction of its length from which an arm eases into full extension. It guards arms that the
ground is too low for: they would snap straight."""
ROUNDING_FRACTION = 0.05
"""Height over which a hand is decelerated above its minimum height, in leg lengths. It guards
hands of a body that lies down, which would sink lower than the source's."""


class GroundHeights(NamedTuple):
    """The ground of source and target."""

    placement: HipPlacement
    floors: tuple[float, float]
    """Height of the ground of source and target, meters."""
    leg: float
    """Leg length of the source, meters."""
    frame_rate: float


def pull_to_ground(
    hand: Array, source_hand: Array, shoulder: Array, length: float, ground: GroundHeights
) -> Array:
    """Return the hand, moved to the source's height above ground where that is low.

    Parameters
    ----------
    hand : shape (n_frames, 3), meters
        Position from the arm alone.
    source_hand : shape (n_frames, 3), meters
        The source's hand.
    shoulder : shape (n_frames, 3), meters
        Start of the arm.
    length : float, meters
        Length of the arm.
    ground : GroundHeights

    Returns
    -------
    NDArray, shape (n_frames, 3), meters
        The lower the source's hand, the more the height follows the source's, scaled by the
        legs. The lower and slower it is, the more the position does, within the arm's reach.
    """
    height = source_hand[:, 2] - ground.floors[0]
    height_weight = smoothstep(height / ground.leg, HIGH_WRIST_FRACTION, LOW_WRIST_FRACTION)
    if not height_weight.any():
        return hand
    velocity = (
        np.gradient(source_hand, axis=0) * ground.frame_rate
        if len(source_hand) > 1
        else 0.0 * source_hand
    )
    speed = np.linalg.norm(velocity, axis=1)
    speed = smooth_gaussian(speed, SPEED_SMOOTHING_S * ground.frame_rate)
    support_weight = smoothstep(
        height / ground.leg, *reversed(SUPPORT_HEIGHT_FRACTIONS)
    ) * smoothstep(speed / ground.leg, PASSING_SPEED, SUPPORT_SPEED)
    target = ground.placement.points(source_hand)
    target[:, 2] = ground.floors[1] + ground.placement.rise * height
    support_weight *= smoothstep(
        np.linalg.norm(target - shoulder, axis=1) / length, 1.0, EASE_EXTENSION_FRACTION
    )
    weights = np.stack([support_weight, support_weight, height_weight], axis=1)
    shift = smooth_gaussian(weights * (target - hand), SHIFT_SMOOTHING_S * ground.frame_rate)
    return np.asarray(hand + shift)


def keep_above_ground(hand: Array, source_hand: Array, ground: GroundHeights) -> Array:
    """Return the hand, shape (n_frames, 3), not below the scaled height of the source's.

    A hand above `LOW_WRIST_FRACTION` in the source stays above that height. The lift eases in
    early and out late, so that the elbow of a nearly straight arm does not accelerate.
    """
    height = np.minimum(source_hand[:, 2] - ground.floors[0], LOW_WRIST_FRACTION * ground.leg)
    min_height = ground.floors[1] + ground.placement.rise * height
    rounding = ROUNDING_FRACTION * ground.placement.rise * ground.leg
    gap = np.abs(hand[:, 2] - min_height)
    raised = hand.copy()
    # A polynomial that is zero from `rounding` above the minimum height.
    blend = np.maximum(rounding - gap, 0.0) ** 2 / (4.0 * rounding)
    raised[:, 2] += _envelope(
        np.maximum(min_height - hand[:, 2], 0.0) + blend, ground.frame_rate
    )
    return raised


def ease_into_extension(arm_vector: Array, free_arm: Array, length: float) -> Array:
    """Return the vector from shoulder to hand, shape (n_frames, 3), eased into full extension.

    The arm does not snap straight if the ground is out of reach. `free_arm` is the vector
    without the ground, whose extension is not reduced.
    """
    target, unconstrained = (
        np.linalg.norm(arm_vector, axis=1),
        np.linalg.norm(free_arm, axis=1),
    )
    begin = np.minimum(np.maximum(EASE_EXTENSION_FRACTION * length, unconstrained), length)
    margin = np.maximum(length - begin, 1e-9)
    reached = begin + margin * -np.expm1(-np.maximum(target - begin, 0.0) / margin)
    return np.asarray(arm_vector * np.minimum(reached / np.maximum(target, 1e-9), 1.0)[:, None])


def _envelope(lift: Array, frame_rate: float) -> Array:
    """Return a smooth upper envelope of the lift, shape (n_frames,)."""
    window = 2 * round(LIFT_EASE_S * frame_rate) + 1
    envelope = maximum_filter1d(lift, window, mode="nearest")
    return np.asarray(uniform_filter1d(envelope, window, mode="nearest"))
