"""Let hands that are near the ground in the source be near it, and go through it nowhere."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d, maximum_filter1d, uniform_filter1d

from .placement import Placement

Array = NDArray[np.float64]

LOW, HIGH = 0.2, 0.4
"""Parts of the leg's length: wrists lower than the first are as far above the ground as in the
source, grown with the legs; those beyond the second know nothing of it."""
TOUCHING = (0.12, 0.18)
"""Likewise for hands that lean on the ground."""
SLOW, FAST = 0.25, 1.0
"""Lengths of the leg per second: low hands slower than the first lean on a place on the ground;
those faster than the second only pass."""
STEADY = 0.1
"""Standard deviation of the blur of the speed, seconds."""
GENTLE = 0.07
"""Standard deviation of the blur of how much hands are shifted, seconds."""
EASE = 0.07
"""Seconds before and after over which hands are lifted off the ground."""
STRAIGHT = 0.9
"""Part of its length from which on an arm eases into full extension to reach the ground."""
ROUNDING = 0.05
"""Part of the leg's length over which a hand slows down before its least height."""


class Ground(NamedTuple):
    """What is known of the ground where hands are placed."""

    placement: Placement
    floors: tuple[float, float]
    """Height of the ground of source and target, metres."""
    leg: float
    """Length of the source's, metres."""
    frame_rate: float


def near_ground(
    hand: Array, seen: Array, shoulder: Array, length: float, ground: Ground
) -> Array:
    """Return where a hand comes that is near the ground in the source.

    Parameters
    ----------
    hand : shape (n_frames, 3), metres
        Where it would be by the arm alone.
    seen : shape (n_frames, 3), metres
        The source's hand.
    shoulder : shape (n_frames, 3), metres
        Where the arm begins.
    length : float, metres
        Of the arm.
    ground : Ground

    Returns
    -------
    NDArray, shape (n_frames, 3), metres
        The lower the source's hand, the more the height is that of the source's, grown with
        the legs; the lower and slower, the more is the whole place, if within the arm's reach.
    """
    height = seen[:, 2] - ground.floors[0]
    low = _falling(height / ground.leg, LOW, HIGH)
    if not low.any():
        return hand
    velocity = np.gradient(seen, axis=0) * ground.frame_rate if len(seen) > 1 else 0.0 * seen
    speed = np.linalg.norm(velocity, axis=1)
    speed = gaussian_filter1d(speed, STEADY * ground.frame_rate, mode="nearest")
    leans = _falling(height / ground.leg, *TOUCHING) * _falling(speed / ground.leg, SLOW, FAST)
    there = ground.placement.points(seen)
    there[:, 2] = ground.floors[1] + ground.placement.rise * height
    leans *= _falling(np.linalg.norm(there - shoulder, axis=1) / length, STRAIGHT, 1.0)
    shares = np.stack([leans, leans, low], axis=1)
    shift = gaussian_filter1d(
        shares * (there - hand), GENTLE * ground.frame_rate, axis=0, mode="nearest"
    )
    return np.asarray(hand + shift)


def above_ground(hand: Array, seen: Array, ground: Ground) -> Array:
    """Return the hand, shape (n_frames, 3), not below where the source's is, grown.

    A hand higher than `LOW` in the source is not below that height. It is lifted smoothly, and
    a little earlier and longer than it must be: a nearly straight arm would fling its elbow.
    """
    height = np.minimum(seen[:, 2] - ground.floors[0], LOW * ground.leg)
    least = ground.floors[1] + ground.placement.rise * height
    rounding = ROUNDING * ground.placement.rise * ground.leg
    gap = np.abs(hand[:, 2] - least)
    raised = hand.copy()
    # A polynomial that leaves the hand as it is from `rounding` above the least height on.
    near = np.maximum(rounding - gap, 0.0) ** 2 / (4.0 * rounding)
    raised[:, 2] += _early(np.maximum(least - hand[:, 2], 0.0) + near, ground.frame_rate)
    return raised


def within_reach(way: Array, arm_alone: Array, length: float) -> Array:
    """Return the way from shoulder to hand, shape (n_frames, 3), eased into full extension.

    The arm does not snap straight where the ground is too far away for it. `arm_alone` is the
    way that the arm would have by itself, which may be as straight as it is.
    """
    wanted, usual = np.linalg.norm(way, axis=1), np.linalg.norm(arm_alone, axis=1)
    begin = np.minimum(np.maximum(STRAIGHT * length, usual), length)
    room = np.maximum(length - begin, 1e-9)
    eased = begin + room * -np.expm1(-np.maximum(wanted - begin, 0.0) / room)
    return np.asarray(way * np.minimum(eased / np.maximum(wanted, 1e-9), 1.0)[:, None])


def _early(lift: Array, frame_rate: float) -> Array:
    """Return a lift that is nowhere less and sets in and fades smoothly, (n_frames,)."""
    window = 2 * round(EASE * frame_rate) + 1
    envelope = maximum_filter1d(lift, window, mode="nearest")
    return np.asarray(uniform_filter1d(envelope, window, mode="nearest"))


def _falling(values: Array, start: float, stop: float) -> Array:
    """Return 1 up to `start`, 0 from `stop` on, and smoothly less in between."""
    share = np.clip((stop - values) / (stop - start), 0.0, 1.0)
    return np.asarray(share * share * (3.0 - 2.0 * share))
