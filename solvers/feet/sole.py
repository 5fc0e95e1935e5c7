"""Estimate which points of a foot, heel, ball or toe tip, carry the load on the floor."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d  # reflects ends; smooth_gaussian repeats them

from ..arrays import Array
from ..motion import Skeleton
from ..motion_fitting.goals import BonePoint
from .legs import LegJoints

HEEL_FRACTION = 0.2
"""Distance of the heel behind the ankle, relative to the distance from ankle to ball. Chosen by
hand: x0.5 gains 0.6 %, x2 costs 1.5 %."""
LOAD_FALLOFF_M = 0.007
"""Meters, for a leg of 0.9 m: a point this far above the lowest carries 1/e of its load. Chosen
by hand: x0.5 costs nothing, x2 gains 0.1 %."""
TIP_HEIGHT_M = 0.012
"""Meters, for a leg of 0.9 m, between ball and tip when both carry the same load. Captured toes
jitter, and a jittering tip should not carry a resting foot. Chosen by hand: x0.5 gains
0.2 %, x2 gains 0.1 %."""
MAX_REST_SPEED = 0.15
"""Meters per second below which the entire foot rests on the floor. Chosen by hand: x0.5 gains
2.8 %, x2 gains 0.3 %."""
SMOOTHING_S = 0.03
"""Seconds over which speeds and heights are smoothed before they are compared. Chosen by hand:
x0.5 costs 0.9 %, x2 gains 1.5 %."""


def sole_points(skeleton: Skeleton, leg: LegJoints) -> tuple[BonePoint, ...]:
    """Return heel, ball and, if the rig has it, the tip of the toes.

    No rig has a heel joint: the heel is assumed below and slightly behind the ankle, as high in
    the rest pose as the ball. The ball is the toe joint, or the end of a foot without toes. The
    tip is the end of the toes, if the rig has it. A foot without children touches the floor
    with its ankle.
    """
    rest = skeleton.rest_positions
    ball = leg.toe if leg.toe is not None else _first_child(skeleton, leg.ankle)
    foot = rest[ball] - rest[leg.ankle]
    heel = np.array([0.0, 0.0, foot[2]]) - HEEL_FRACTION * foot * (1.0, 1.0, 0.0)
    points = [BonePoint(leg.ankle, heel), BonePoint(ball, np.zeros(3))]
    if leg.toe is not None and (tip := _first_child(skeleton, leg.toe)) != leg.toe:
        points.append(BonePoint(tip, np.zeros(3)))
    return tuple(points)


def measure_standing_heights(
    points: Array, contact: NDArray[np.bool_], frame_rate: float
) -> Array:
    """Return the height of each point above the ball while the foot rests, (n_points,).

    Rest poses do not always have flat feet, so the heights are measured in contact where no
    point moves. A foot that never rests is assumed to have a level sole.
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
    """Return the fraction of the load on each point, (n_frames, n_points), summing to 1.

    The lowest points carry it. As the foot rolls, the load moves smoothly from heel to ball to
    tip.

    Parameters
    ----------
    heights : shape (n_frames, n_points), meters
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
    """Return the joint's first child, or itself if it has none."""
    return next(iter(skeleton.children[joint]), joint)
