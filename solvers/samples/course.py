"""Where the walker goes and when each step falls, with the small irregularities of a person."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from .footsteps import UNDER_HIP, FootPath, foot_path
from .walker import ANKLE_HEIGHT

Array = NDArray[np.float64]

MARGIN = 5
"""Steps before the first and after the last frame, so that every curve has both ends."""
STEP_WIDTH = 0.15
"""Between the ankles, across the direction of walking, metres."""
TOES_OUT = np.radians(6.0)
STEP_TIME_NOISE, STEP_PLACE_NOISE, STEP_HEADING_NOISE = 0.012, 0.006, np.radians(1.5)
"""From step to step, as a share of the step's duration, metres and radians: healthy adults."""
SPEED_NOISE = 0.03
TURN_STEPS = 6.0
"""Number of steps after which the direction of walking has forgotten itself."""


@dataclass(frozen=True, eq=False)
class Course:
    """The plan of a walk, sampled at the frames.

    Attributes
    ----------
    steps : shape (n_frames,)
        Number of steps made; step k stands under the hip at steps == k, left for even k.
    ground : shape (n_frames, 3), metres
        The point on the floor that the body passes over.
    heading : shape (n_frames,), radians
        Direction of walking about Z; 0 is towards -Y.
    feet : pair of FootPath
        Left and right.
    span : pair of float
        First and last step of the plan; the frames lie between.
    rng : source of the irregularities that are still to be drawn
    """

    steps: Array
    ground: Array
    heading: Array
    feet: tuple[FootPath, FootPath]
    span: tuple[float, float]
    rng: np.random.Generator

    def wander(self, size: float, n_steps: float = 2.0) -> Array:
        """Return a smooth random curve, shape (n_frames,), of about standard deviation `size`,
        that forgets itself within `n_steps`.
        """
        return np.asarray(size * _noise_curve(self.rng, self.span, n_steps)(self.steps))


def plan_course(
    time: Array, duration: float, speed: float, step_time: float, turning: float, seed: int
) -> Course:
    """Lay out the path, the step times and the places of the feet.

    Parameters
    ----------
    time : shape (n_frames,), seconds
    duration : seconds
        What is drawn depends on this and not on the frames: any frame rate shows one walk.
    speed : metres per second
    step_time : seconds from one step to the next
    turning : radians
        Standard deviation of the direction of walking.
    seed : int
    """
    rng = np.random.default_rng(seed)
    last = int(duration / step_time) + MARGIN
    index = np.arange(-MARGIN, last + 1)
    when = (index + STEP_TIME_NOISE * rng.normal(size=len(index))) * step_time

    # The path is integrated on a grid of its own, so that it is the same at any frame rate.
    grid = np.linspace(when[0], when[-1], 40 * len(index))
    span = (when[0] / step_time, when[-1] / step_time)
    heading = turning * _noise_curve(rng, span, TURN_STEPS)(grid / step_time)
    pace = speed * (1.0 + SPEED_NOISE * _noise_curve(rng, span, TURN_STEPS)(grid / step_time))
    velocity = CubicSpline(grid, pace[:, None] * _forward(heading))
    place, direction = velocity.antiderivative(), CubicSpline(grid, heading)

    def on_ground(at: Array) -> Array:
        flat = place(at) - place(time[0])
        return np.column_stack([flat, np.zeros(len(flat))])

    feet = []
    for first, side in ((0, 1.0), (1, -1.0)):
        mine = (index - first) % 2 == 0
        yaw = direction(when[mine])
        left = _forward(yaw + np.pi / 2)
        ankles = on_ground(when[mine])
        ankles[:, 2] = ANKLE_HEIGHT
        ankles[:, :2] += side * STEP_WIDTH / 2 * left
        ankles[:, :2] += STEP_PLACE_NOISE * rng.normal(size=(len(yaw), 2))
        yaw = yaw + side * TOES_OUT + STEP_HEADING_NOISE * rng.normal(size=len(yaw))
        strides = (CubicSpline(when, index)(time) - index[mine][0]) / 2.0 + UNDER_HIP
        feet.append(foot_path(strides, ankles, yaw))
    steps = CubicSpline(when, index)(time)
    return Course(steps, on_ground(time), direction(time), (feet[0], feet[1]), span, rng)


def _forward(heading: Array) -> Array:
    """Unit vectors on the floor, shape (..., 2); heading 0 is -Y, growing towards the left."""
    return np.stack([np.sin(heading), -np.cos(heading)], axis=-1)


def _noise_curve(
    rng: np.random.Generator, span: tuple[float, float], spacing: float
) -> CubicSpline:
    """A smooth curve over `span` through one normal number per `spacing`."""
    knots = np.arange(np.floor(span[0] / spacing) - 1, np.ceil(span[1] / spacing) + 2)
    return CubicSpline(knots * spacing, rng.normal(size=len(knots)))
