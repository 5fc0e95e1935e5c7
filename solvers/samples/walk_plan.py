"""Plan the path and the step times of a walk, with natural irregularities."""

from dataclasses import dataclass

import numpy as np
import scipy

from ..arrays import Array
from .footsteps import MID_STANCE, FootTrajectory, plan_foot_path
from .walker import ANKLE_HEIGHT_M

N_MARGIN_STEPS = 5
"""Steps before the first and after the last frame, so that every curve is defined at both
ends."""
STEP_WIDTH_M = 0.15
"""Distance of the ankles across the direction of walking."""
TOE_OUT_RAD = np.radians(6.0)
STEP_TIME_STD, STEP_POSITION_STD_M, STEP_HEADING_STD_RAD = 0.012, 0.006, np.radians(1.5)
"""Standard deviations from step to step, as a fraction of the step's duration, meters and
radians: healthy adults."""
SPEED_STD = 0.03
N_HEADING_STEPS = 6.0
"""Number of steps after which the direction of walking is uncorrelated."""


@dataclass(frozen=True, eq=False)
class WalkPlan:
    """The plan of a walk, sampled at the frames.

    Attributes
    ----------
    steps : shape (n_frames,)
        Number of completed steps; at steps == k, step k stands under the hip, left for even k.
    ground : shape (n_frames, 3), meters
        The point on the floor below the body.
    heading : shape (n_frames,), radians
        Direction of walking about Z; 0 is toward -Y.
    feet : pair of FootTrajectory
        Left and right.
    span : pair of float
        First and last step of the plan; the frames lie between.
    rng : source of the irregularities that are still to be drawn
    """

    steps: Array
    ground: Array
    heading: Array
    feet: tuple[FootTrajectory, FootTrajectory]
    span: tuple[float, float]
    rng: np.random.Generator

    def random_curve(self, size: float, n_steps: float = 2.0) -> Array:
        """Return a smooth random curve, shape (n_frames,), with a standard deviation of about
        `size` and a correlation length of `n_steps`."""
        return np.asarray(size * _noise_curve(self.rng, self.span, n_steps)(self.steps))


def plan_walk(
    time: Array, duration: float, speed: float, step_time: float, turning: float, seed: int
) -> WalkPlan:
    """Plan the path, the step times and the foot positions.

    Parameters
    ----------
    time : shape (n_frames,), seconds
    duration : seconds
        Random draws depend on this and not on the frames: the walk is the same at any frame
        rate.
    speed : meters per second
    step_time : seconds from one step to the next
    turning : radians
        Standard deviation of the direction of walking.
    seed : int
    """
    rng = np.random.default_rng(seed)
    last = int(duration / step_time) + N_MARGIN_STEPS
    index = np.arange(-N_MARGIN_STEPS, last + 1)
    step_times = (index + STEP_TIME_STD * rng.normal(size=len(index))) * step_time

    # The path is integrated on a grid of its own, so that it is the same at any frame rate.
    grid = np.linspace(step_times[0], step_times[-1], 40 * len(index))
    span = (step_times[0] / step_time, step_times[-1] / step_time)
    heading = turning * _noise_curve(rng, span, N_HEADING_STEPS)(grid / step_time)
    speeds = speed * (
        1.0 + SPEED_STD * _noise_curve(rng, span, N_HEADING_STEPS)(grid / step_time)
    )
    velocity = scipy.interpolate.CubicSpline(grid, speeds[:, None] * _forward(heading))
    path, direction = velocity.antiderivative(), scipy.interpolate.CubicSpline(grid, heading)

    def on_ground(times: Array) -> Array:
        horizontal = path(times) - path(time[0])
        return np.column_stack([horizontal, np.zeros(len(horizontal))])

    feet = []
    for first, side in ((0, 1.0), (1, -1.0)):
        own_steps = (index - first) % 2 == 0
        yaw = direction(step_times[own_steps])
        left = _forward(yaw + np.pi / 2)
        ankles = on_ground(step_times[own_steps])
        ankles[:, 2] = ANKLE_HEIGHT_M
        ankles[:, :2] += side * STEP_WIDTH_M / 2 * left
        ankles[:, :2] += STEP_POSITION_STD_M * rng.normal(size=(len(yaw), 2))
        yaw = yaw + side * TOE_OUT_RAD + STEP_HEADING_STD_RAD * rng.normal(size=len(yaw))
        strides = (
            scipy.interpolate.CubicSpline(step_times, index)(time) - index[own_steps][0]
        ) / 2.0 + MID_STANCE
        feet.append(plan_foot_path(strides, ankles, yaw))
    steps = scipy.interpolate.CubicSpline(step_times, index)(time)
    return WalkPlan(steps, on_ground(time), direction(time), (feet[0], feet[1]), span, rng)


def _forward(heading: Array) -> Array:
    """Return unit vectors on the floor, shape (..., 2); heading 0 is -Y and grows to the
    left."""
    return np.stack([np.sin(heading), -np.cos(heading)], axis=-1)


def _noise_curve(
    rng: np.random.Generator, span: tuple[float, float], spacing: float
) -> "scipy.interpolate.CubicSpline":
    """Return a smooth curve over `span` through one normal number per `spacing`."""
    knots = np.arange(np.floor(span[0] / spacing) - 1, np.ceil(span[1] / spacing) + 2)
    return scipy.interpolate.CubicSpline(knots * spacing, rng.normal(size=len(knots)))
