"""Offset the hips where a leg would be too short for its footplant."""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array
from ...motion import Skeleton, WorldPoses
from ...signals import smooth_correction
from .foot_trajectory import FootTrajectory

BLEND_FACTOR = 2.0
"""The body is heavier than a foot: its offset fades over this many times the blend. Chosen by
hand: x0.5 costs 0.2 %, x2 costs 0.3 %."""


def compute_root_offset(
    skeleton: Skeleton,
    poses: WorldPoses,
    trajectories: Sequence[FootTrajectory],
    frame_rate: float,
    *,
    softness: float,
    blend: float,
) -> Array:
    """Return a smooth root offset, (n_frames, 3), that lets the legs reach their targets.

    The goals are the frames in contact where a leg is too short: the missing distance along
    the leg, of the leg that misses more. The smoothest curve joins them (`smooth_correction`).

    Parameters
    ----------
    skeleton : Skeleton
    poses : WorldPoses
    trajectories : sequence of FootTrajectory
    frame_rate : float, hertz
    softness : float
        Fraction of a leg's length that is not used, unless its pose already uses it.
    blend : float, seconds
        Time over which a foot's correction fades.
    """
    n_frames = len(poses.positions)
    goal = np.zeros((n_frames, 3))
    for trajectory in trajectories:
        missing = _missing_reach(skeleton, poses, trajectory, softness)
        larger = np.linalg.norm(missing, axis=1) > np.linalg.norm(goal, axis=1)
        goal = np.where(larger[:, None], missing, goal)
    goal_weight = np.repeat(goal.any(axis=1)[:, None], 3, axis=1).astype(np.float64)
    no_velocity = np.zeros((n_frames - 1, 3)), np.zeros(n_frames - 1)
    return smooth_correction(
        *no_velocity, frame_rate, BLEND_FACTOR * blend, goal=goal, pulled=goal_weight
    )


def _missing_reach(
    skeleton: Skeleton,
    poses: WorldPoses,
    trajectory: FootTrajectory,
    softness: float,
) -> Array:
    """Return the displacement by which the root must approach the foot, (n_frames, 3)."""
    hip, knee, ankle = (poses.positions[:, joint] for joint in trajectory.leg.chain)
    leg_length = np.linalg.norm(knee - hip, axis=1) + np.linalg.norm(ankle - knee, axis=1)
    usable_length = np.maximum(
        (1.0 - softness) * leg_length, np.linalg.norm(ankle - hip, axis=1)
    )
    to_ankle = trajectory.ankle - hip
    distance = np.linalg.norm(to_ankle, axis=1)
    leg_missing = np.where(trajectory.contact, np.maximum(distance - usable_length, 0.0), 0.0)
    return np.asarray(to_ankle * (leg_missing / np.maximum(distance, 1e-9))[:, None])
