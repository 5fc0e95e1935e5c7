"""Place the feet of a target on the ground in stance, and above it in swing."""

import numpy as np

from ..arrays import Array
from ..motion import Motion, forward_kinematics, reach
from ..motion.humanoid import SIDES, UP
from ..signals import smooth_gaussian
from .body import PhysicsBody
from .body_surface import find_leg_chain, lowest_points, select_foot_ends

MIN_SWING_CLEARANCE_M = 0.01
"""Minimum height of a swinging foot above the ground in meters, for legs of 0.9 m. Half and
twice are no better (`make sensitivity`)."""

STANCE_DEPTH_M = 0.003
"""Depth of a standing foot below the ground, likewise, so that it carries its load. Chosen by
hand; `make sensitivity` varies it."""

MAX_STANCE_DISTANCE_M = 0.1
"""Maximum distance from the ground, likewise: a standing foot farther away stands on something
else. A swinging foot is lifted from any depth. Chosen by hand; `make sensitivity` varies it."""

CORRECTION_SMOOTHING_S = 0.03
"""Standard deviation in seconds of the Gaussian that smooths the corrections of foot heights.
Chosen by hand; `make sensitivity` varies it."""


def place_feet_on_ground(
    body: PhysicsBody, motion: Motion, slow_weights: Array, stance_weights: Array, ground: float
) -> Motion:
    """Return the motion with legs flexed or extended so that the feet meet the ground.

    Sole thickness is not captured, and the floor of a take is level to a centimeter at best. A
    foot that swings into the ground would scuff it. One that hovers in stance would leave all
    the weight to the other: the body tips.

    Parameters
    ----------
    body : PhysicsBody
    motion : Motion
    slow_weights : shape (n_frames, 2), 0 to 1
        1 for a foot slow enough to stand, 0 for one that swings.
    stance_weights : shape (n_frames, 2), 0 to 1
        1 for a foot that stands.
    ground : float, meters
    """
    points = lowest_points(body, motion)
    positions, result = forward_kinematics(motion).positions, motion
    for column, side in enumerate(SIDES):
        ends, chain = select_foot_ends(body, side), find_leg_chain(body, side)
        if chain and ends.any():
            heights = (points[:, ends, 2].min(axis=1) - ground) / body.size
            corrections = _foot_corrections(
                heights, slow_weights[:, column], stance_weights[:, column]
            )
            corrections = smooth_gaussian(
                corrections, CORRECTION_SMOOTHING_S * motion.frame_rate
            )
            goal = positions[:, chain[-1]] + body.size * corrections[:, None] * UP
            result = reach(result, chain, goal)
    return result


def _foot_corrections(heights: Array, slow_weights: Array, stance_weights: Array) -> Array:
    """Return height corrections of a foot, shape (n_frames,), for legs of 0.9 m."""
    closeness = np.clip(2.0 - 2.0 * np.abs(heights) / MAX_STANCE_DISTANCE_M, 0.0, 1.0)
    lifted = (1.0 - slow_weights) * np.maximum(MIN_SWING_CLEARANCE_M - heights, 0.0)
    return np.asarray(lifted - stance_weights * closeness * (heights + STANCE_DEPTH_M))
