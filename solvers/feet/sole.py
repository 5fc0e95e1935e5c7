"""Estimate which point of a foot rests while in contact: heel, ball, toe tip or ankle."""

import numpy as np
import scipy
from numpy.typing import NDArray

from ..arrays import Array
from ..motion import Skeleton
from ..motion.humanoid import ball_of_foot
from ..motion_fitting.goals import BonePoint
from .legs import LegJoints

HEEL_FRACTION = 0.2
"""Distance of the heel behind the ankle, relative to the distance from ankle to ball. Half and
twice gain less than 1 % (`make sensitivity`)."""
LOAD_FALLOFF_M = 0.007
"""Meters, for a leg of 0.9 m: a point this far above the lowest carries 1/e of its load. Half
and twice are no better (`make sensitivity`)."""
SPEED_FALLOFF = 0.1
"""Meters per second, for a leg of 0.9 m: a point this much faster than the slowest carries 1/e
of its load. X1.5 makes the worst knee of squats whose feet were captured badly jerk 1.5 times
as much. Half and twice are no better (`make sensitivity`)."""
MIN_RISE_M = 0.012
"""Meters, for a leg of 0.9 m, by which heel and ball are higher than the tip (or than the ankle
above its own height at rest) when all carry the same load. Captured toes jitter, and a
jittering tip should not carry a resting foot. Half and twice gain less than 1 %
(`make sensitivity`)."""
MAX_REST_SPEED = 0.15
"""Meters per second below which the entire foot rests on the floor. Chosen by hand;
`make sensitivity` varies it."""
SMOOTHING_S = 0.03
"""Seconds over which speeds and heights are smoothed before they are compared. Half and twice
gain less than 1 % (`make sensitivity`)."""


def sole_points(skeleton: Skeleton, leg: LegJoints) -> tuple[BonePoint, ...]:
    """Return heel, ball and, if the rig has it, the tip of the toes.

    No rig has a heel joint: the heel is assumed below and slightly behind the ankle, as high in
    the rest pose as the ball. The ball is the toe joint, or the end of a foot without toes. The
    tip is the end of the toes, if the rig has it. A foot without children touches the floor
    with its ankle.
    """
    rest = skeleton.rest_positions
    ball = leg.toe if leg.toe is not None else ball_of_foot(skeleton, leg.ankle)
    foot = rest[ball] - rest[leg.ankle]
    heel = np.array([0.0, 0.0, foot[2]]) - HEEL_FRACTION * foot * (1.0, 1.0, 0.0)
    points = [BonePoint(leg.ankle, heel), BonePoint(ball, np.zeros(3))]
    if leg.toe is not None and skeleton.children[leg.toe]:
        points.append(BonePoint(skeleton.children[leg.toe][0], np.zeros(3)))
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
        rests = contact & (_speeds(points, frame_rate) < MAX_REST_SPEED).all(axis=1)
        if rests.any():
            level = np.median((points - points[:, 1:2])[rests, :, 2], axis=0)
    return level


def estimate_loads(points: Array, standing: Array, frame_rate: float, size: float) -> Array:
    """Return the fraction of the load on each point, (n_frames, n_points), summing to 1.

    The lowest and slowest points carry it. As the foot rolls, the load moves smoothly from heel
    to ball to tip. Where all three swing about an ankle that stands, the rotation of the foot
    was captured badly, and the ankle carries it.

    Parameters
    ----------
    points : shape (n_frames, n_points, 3), meters
        Heel, ball, tip if the rig has one, and ankle.
    standing : shape (n_points,), meters
        Their heights while the foot rests, as `measure_standing_heights` returns them.
    frame_rate : float, hertz
    size : float
        Of the body, 1 for a leg of 0.9 m.
    """
    heights, speeds = smoothed_paths(points, frame_rate)
    return instant_loads(heights - standing, speeds, size)


def smoothed_paths(points: Array, frame_rate: float) -> tuple[Array, Array]:
    """Return the smoothed heights in meters and speeds in meters per second of points.

    Both have the shape (n_frames, n_points).
    """
    # It reflects ends; smooth_gaussian repeats them.
    heights = scipy.ndimage.gaussian_filter1d(points[..., 2], SMOOTHING_S * frame_rate, axis=0)
    speeds = _speeds(points, frame_rate) if len(points) > 1 else np.zeros_like(heights)
    return heights, speeds


def instant_loads(heights: Array, speeds: Array, size: float) -> Array:
    """Return the loads of `estimate_loads` from heights above those at rest, and speeds.

    Both have the shape (..., n_points), meters and meters per second, and so has the result.
    """
    is_beyond_ball = np.arange(heights.shape[-1]) >= 2
    return load_shares(heights + MIN_RISE_M * size * is_beyond_ball, speeds, size)


def load_shares(heights: Array, speeds: Array, size: float) -> Array:
    """Return the fraction of the load on each of some points: the lowest and slowest carry it.

    Heights in meters and speeds in meters per second have the shape (..., n_points), and so
    has the result.
    """
    log_load = -heights / (LOAD_FALLOFF_M * size) - speeds / (SPEED_FALLOFF * size)
    fractions = np.exp(log_load - log_load.max(axis=-1, keepdims=True))
    return np.asarray(fractions / fractions.sum(axis=-1, keepdims=True))


def _speeds(points: Array, frame_rate: float) -> Array:
    """Return the smoothed speeds of points in meters per second, (n_frames, n_points)."""
    speeds = np.linalg.norm(np.gradient(points, axis=0), axis=-1) * frame_rate
    return np.asarray(scipy.ndimage.gaussian_filter1d(speeds, SMOOTHING_S * frame_rate, axis=0))
