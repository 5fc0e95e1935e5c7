"""Where a foot touches the floor: heel, ball and toe tip, and which of them carry it."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ...motion import Skeleton, WorldPoses
from ...rotations import rotate
from .legs import Leg

Array = NDArray[np.float64]

HEEL_FRACTION = 0.2
"""How far the heel is behind the ankle, as part of the way from ankle to ball."""
LOAD_FALLOFF_M = 0.007
"""Metres, for a leg of 0.9 m: a point this much above the lowest carries 1/e of its load."""
TIP_HEIGHT_M = 0.012
"""Metres, for a leg of 0.9 m, by which the ball is above the tip when both carry as much:
captured toes tremble, and a trembling tip should not carry a resting foot."""
MAX_REST_SPEED = 0.15
"""Metres per second below which all of the foot rests on the floor."""
SMOOTHING_S = 0.03
"""Seconds over which speeds and heights are smoothed before they are judged."""


def sole_points(skeleton: Skeleton, poses: WorldPoses, leg: Leg) -> Array:
    """Return heel, ball and toe tip in the world, shape (n_frames, 2 or 3, 3), metres.

    No rig has a heel: it is taken to be below and a little behind the ankle, as high in the
    rest pose as the ball. The ball is the toe joint, or the end of a foot without toes; the
    tip is the end of the toes, if the rig knows it. A foot that is a mere ankle touches the
    floor with that.
    """
    rest = skeleton.rest_positions
    ball = leg.toe if leg.toe is not None else _first_child(skeleton, leg.ankle)
    foot = rest[ball] - rest[leg.ankle]
    heel = np.array([0.0, 0.0, foot[2]]) - HEEL_FRACTION * foot * (1.0, 1.0, 0.0)
    ankle = poses.positions[:, leg.ankle]
    points = [ankle + rotate(poses.rotations[:, leg.ankle], heel), poses.positions[:, ball]]
    if leg.toe is not None and (tip := _first_child(skeleton, leg.toe)) != leg.toe:
        points.append(poses.positions[:, tip])
    return np.stack(points, axis=1)


def measure_standing_heights(
    points: Array, contact: NDArray[np.bool_], frame_rate: float
) -> Array:
    """Return how much higher than the ball each point is when the foot rests, (n_points,).

    Rest poses are not always drawn with flat feet, so it is measured where all points stand
    still in contact; a foot that never rests is taken to have a level sole.
    """
    level = np.zeros(points.shape[1])
    if len(points) > 1:
        speeds = np.linalg.norm(np.gradient(points, axis=0), axis=-1) * frame_rate
        speeds = gaussian_filter1d(speeds, SMOOTHING_S * frame_rate, axis=0)
        rests = contact & (speeds < MAX_REST_SPEED).all(axis=1)
        if rests.any():
            level = np.median((points - points[:, 1:2])[rests, :, 2], axis=0)
    return level


def estimate_loads(heights: Array, frame_rate: float, size: float) -> Array:
    """Return which part of the load each point carries, (n_frames, n_points), summing to 1.

    The lowest carry it; as the foot rolls it passes smoothly from heel to ball to tip.

    Parameters
    ----------
    heights : shape (n_frames, n_points), metres
        Above the floor on which the foot rests.
    frame_rate : float, hertz
    size : float
        Of the body, 1 for a leg of 0.9 m.
    """
    smoothed = gaussian_filter1d(heights, SMOOTHING_S * frame_rate, axis=0)
    smoothed[:, 2:] += TIP_HEIGHT_M * size
    fractions = np.exp(
        (smoothed.min(axis=1, keepdims=True) - smoothed) / (LOAD_FALLOFF_M * size)
    )
    return np.asarray(fractions / fractions.sum(axis=1, keepdims=True))


def _first_child(skeleton: Skeleton, joint: int) -> int:
    """Return the joint's first child, or itself where it has none."""
    return next(iter(skeleton.children[joint]), joint)
