"""Keep standing feet from creeping and slipping."""

from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..motion import Motion, WorldPoses, forward_kinematics, reach
from ..motion.humanoid import UP
from ..rotations import (
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
    rotation_vector_from_quaternion,
)
from ..signals import smooth_correction
from .body import PhysicsBody
from .body_surface import SIDES, find_leg_chain, lowest_points, select_foot_ends
from .foot_support import distribute_load
from .pelvis_offset import LegGoal, solve_pelvis_offset

MIN_FRAMES = 4
"""Minimum frames in which a foot can stand. It guards takes too short for a second
difference."""

BLEND_S = 0.3
"""Seconds over which a released foot blends to its own motion, and a simulated body to the take
next to a failure. Chosen by hand: x0.5 costs
0.9 %, x2 costs 0.6 %."""

MAX_TURN_RATE_RAD_S = 0.6
"""Radians per second: a foot that rotates faster on the ground does so on purpose. Chosen by
hand: x0.5 costs 1.5 %, x2 gains 1.0 %."""


class FootPlan(NamedTuple):
    """A leg's goal, and the rotation of its foot."""

    goal: LegGoal
    rotations: Array
    """World rotation about the vertical to add to the foot's own, shape (n_frames, 4)."""


def plant_target_feet(
    body: PhysicsBody, motion: Motion, hold_weights: Array, ground: float
) -> Motion:
    """Return the motion with feet that do not move over the ground while they are held.

    The loaded part of the sole (heel, ball or toes) keeps its position. The displacement and
    rotation that this requires fade while the foot is free. Corrections are horizontal and
    about the vertical only, so that no foot sinks or rises. Inverse kinematics moves hips and
    knees, and the pelvis is offset a little where a knee would overextend.

    Parameters
    ----------
    body : PhysicsBody
    motion : Motion
    hold_weights : shape (n_frames - 1, 2), 0 to 1
        How firmly each foot is held from each frame to the next.
    ground : float, meters
    """
    if motion.n_frames < MIN_FRAMES:
        return motion
    poses, points, feet = forward_kinematics(motion), lowest_points(body, motion), []
    for column, side in enumerate(SIDES):
        chain = find_leg_chain(body, side)
        if chain and hold_weights[:, column].any():
            sole, frame_rate = points[:, select_foot_ends(body, side)], motion.frame_rate
            load_fractions = distribute_load(sole[..., 2] - ground, frame_rate, body.size)
            feet.append(
                _plan_foot(
                    sole, load_fractions, poses, chain, hold_weights[:, column], frame_rate
                )
            )
    if not feet:
        return motion
    goals = [foot.goal for foot in feet]
    shift = solve_pelvis_offset(poses, goals, motion.frame_rate, body.size)
    result = motion.with_poses(root_positions=motion.root_positions + shift)
    for foot in feet:
        result = _apply_foot_plan(result, poses, foot)
    return result


def _plan_foot(
    sole: Array,
    load_fractions: Array,
    poses: WorldPoses,
    chain: tuple[int, int, int],
    hold_weights: Array,
    frame_rate: float,
) -> FootPlan:
    """Plan the trajectory of a foot from its hold weights, shape (n_frames - 1,).

    `sole` are points, shape (n_frames, n_points, 3), and `load_fractions` their fractions of
    the load.
    """
    ankle = poses.positions[:, chain[-1]]
    rotations = _counter_rotations(poses.rotations[:, chain[-1]], hold_weights, frame_rate)
    points = ankle[:, None] + rotate(rotations[:, None], sole - ankle[:, None])
    mean_fractions = 0.5 * (load_fractions[1:] + load_fractions[:-1])
    steps = np.einsum("fp,fpi->fi", mean_fractions, np.diff(points, axis=0))
    shift = smooth_correction(-steps * frame_rate, hold_weights, frame_rate, BLEND_S) * (
        1.0,
        1.0,
        0.0,
    )
    return FootPlan(LegGoal(chain, ankle + shift), rotations)


def _counter_rotations(rotations: Array, hold_weights: Array, frame_rate: float) -> Array:
    """Return rotations about the vertical, (n_frames, 4), that cancel slow rotation of a
    foot."""
    steps = rotation_vector_from_quaternion(multiply(rotations[1:], inverse(rotations[:-1])))
    speeds = np.abs(steps[:, 2:]) * frame_rate
    slow = np.clip(2.0 - 2.0 * speeds[:, 0] / MAX_TURN_RATE_RAD_S, 0.0, 1.0)
    angles = smooth_correction(
        -steps[:, 2:] * frame_rate, hold_weights * slow, frame_rate, BLEND_S
    )
    return quaternion_from_rotation_vector(angles * UP)


def _apply_foot_plan(motion: Motion, poses: WorldPoses, foot: FootPlan) -> Motion:
    """Return the motion with the ankle on its trajectory and the foot rotated as planned.

    `poses` are those of the motion before any correction.
    """
    ankle = foot.goal.chain[-1]
    result = reach(motion, foot.goal.chain, foot.goal.ankle)
    parent_rotations = forward_kinematics(result).rotations[:, motion.skeleton.parents[ankle]]
    rotations = result.rotations.copy()
    foot_rotations = multiply(foot.rotations, poses.rotations[:, ankle])
    rotations[:, ankle] = multiply(inverse(parent_rotations), foot_rotations)
    return result.with_poses(rotations)
