"""Keep feet from creeping and slipping where they stand."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..motion import Motion, ReachSettings, WorldPoses, forward_kinematics, reach
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
from .pelvis_offset import LegGoal, hips_shift
from .stance import bearing
from .surface import SIDES, bottoms, leg_chain, of_foot

Array = NDArray[np.float64]
FEWEST = 4
"""Frames in which a foot can stand."""

BLEND = 0.3
"""Seconds over which a foot that no longer stands eases into its own motion."""

TURNING = 0.6
"""Radians per second: a foot that turns faster on the ground means to."""

SOFTNESS = 0.01
"""Part of a leg's length that is kept in reserve so that knees do not snap straight."""


class Foot(NamedTuple):
    """A leg, and the course that its foot should take."""

    goal: LegGoal
    turn: Array
    """World rotation about the vertical to add to the foot's own, shape (n_frames, 4)."""


def planted(body: PhysicsBody, motion: Motion, held: Array, ground: float) -> Motion:
    """Return the motion with feet that do not move over the ground where they are held.

    The part of the sole that carries the foot, heel, ball or toes, stays where it is; the shift
    and the turn that this takes fade while the foot is free. Feet are shifted and turned level
    with the ground only, so that none sinks or rises; hips and knees turn after them, and the
    hips give way a little where a knee would suffer.

    Parameters
    ----------
    body : PhysicsBody
    motion : Motion
    held : shape (n_frames - 1, 2), 0 to 1
        How firmly each foot is held from each frame to the next.
    ground : float, metres
    """
    if motion.n_frames < FEWEST:
        return motion
    poses, points, feet = forward_kinematics(motion), bottoms(body, motion), []
    for column, side in enumerate(SIDES):
        chain = leg_chain(body, side)
        if chain and held[:, column].any():
            sole, rate = points[:, of_foot(body, side)], motion.frame_rate
            share = bearing(sole[..., 2] - ground, rate, body.size)
            feet.append(_foot(sole, share, poses, chain, held[:, column], rate))
    if not feet:
        return motion
    goals = [foot.goal for foot in feet]
    shift = hips_shift(poses, goals, motion.frame_rate, body.size)
    result = motion.with_poses(root_positions=motion.root_positions + shift)
    for foot in feet:
        result = _followed(result, poses, foot)
    return result


def _foot(
    sole: Array,
    share: Array,
    poses: WorldPoses,
    chain: tuple[int, int, int],
    held: Array,
    rate: float,
) -> Foot:
    """Plan the course of a foot that is `held` from frame to frame, shape (n_frames - 1,).

    `sole` are points, shape (n_frames, n_points, 3), each of which bears a `share` of the load.
    """
    ankle = poses.positions[:, chain[-1]]
    turn = _turn(poses.rotations[:, chain[-1]], held, rate)
    points = ankle[:, None] + rotate(turn[:, None], sole - ankle[:, None])
    both = 0.5 * (share[1:] + share[:-1])
    steps = np.einsum("fp,fpi->fi", both, np.diff(points, axis=0))
    shift = smooth_correction(-steps * rate, held, rate, BLEND) * (1.0, 1.0, 0.0)
    return Foot(LegGoal(chain, ankle + shift), turn)


def _turn(rotations: Array, held: Array, rate: float) -> Array:
    """Return turns about the vertical, (n_frames, 4), by which a foot that hardly turns does
    not turn at all.
    """
    steps = rotation_vector_from_quaternion(multiply(rotations[1:], inverse(rotations[:-1])))
    speeds = np.abs(steps[:, 2:]) * rate
    slow = np.clip(2.0 - 2.0 * speeds[:, 0] / TURNING, 0.0, 1.0)
    angles = smooth_correction(-steps[:, 2:] * rate, held * slow, rate, BLEND)
    return quaternion_from_rotation_vector(angles * UP)


def _followed(motion: Motion, poses: WorldPoses, foot: Foot) -> Motion:
    """Return the motion whose ankle follows its course, the foot turned as it should be.

    `poses` are those of the motion before anything was changed.
    """
    ankle = foot.goal.chain[-1]
    settings = ReachSettings(softness=SOFTNESS)
    result = reach(motion, foot.goal.chain, foot.goal.ankle, settings)
    above = forward_kinematics(result).rotations[:, motion.skeleton.parents[ankle]]
    rotations = result.rotations.copy()
    wanted = multiply(foot.turn, poses.rotations[:, ankle])
    rotations[:, ankle] = multiply(inverse(above), wanted)
    return result.with_poses(rotations)
