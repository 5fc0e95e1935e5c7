"""Change all joints a little so that together they come nearer to observed positions."""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array
from ...motion import Motion
from ...motion_fitting import FittedMotion, Goal, fit_in_windows, fit_motion
from ...motion_fitting.goals import BonePoint, FollowPosition, FollowSource
from ...progress import Progress, unwatched
from ...signals import fill_gaps, fill_rotation_gaps

POSITION_M = 0.02
"""Meters by which a reliable joint may miss its observed position. Half and twice are no better
(`make sensitivity`)."""
ROTATION_RAD = 0.2
"""Radians by which a joint may turn from where its bone was aimed; the root may move by the
meters that this turn moves at a distance of one meter. Half and twice are no better
(`make sensitivity`)."""
FADE_S = 0.1
"""Seconds in which a change fades that no position asks for. Half and twice gain less than 1 %
(`make sensitivity`)."""


def fit_to_positions(
    motion: Motion, positions: Array, weights: Array, progress: Progress = unwatched
) -> Motion:
    """Return the motion that comes near to observed joints with the least, smooth change.

    Parameters
    ----------
    motion : Motion
        Near the positions. Frames with unknown rotations stay unchanged.
    positions : shape (n_frames, n_joints, 3), meters
        Observed joints; NaN where unknown.
    weights : shape (n_joints,), 0 to any
        0 where a joint is to be ignored.
    """
    is_complete = motion.observed.all(axis=1) & np.isfinite(motion.root_positions).all(axis=1)
    if not is_complete.any():
        return motion
    gap_free = motion.with_poses(
        fill_rotation_gaps(motion.rotations), fill_gaps(motion.root_positions)
    )
    is_known = np.isfinite(positions).all(axis=2) & is_complete[:, None]
    positions = np.where(is_known[..., None], positions, 0.0)
    residual_weights = np.sqrt(weights) * is_known

    def fit_window(start: int, stop: int, progress: Progress) -> Motion:
        window = gap_free.slice(start, stop)
        frames = slice(start, stop)
        return _fit_window(window, positions[frames], residual_weights[frames], progress)

    fitted = fit_in_windows(gap_free, fit_window, progress)
    return motion.with_poses(
        np.where(is_complete[:, None, None], fitted.rotations, motion.rotations),
        np.where(is_complete[:, None], fitted.root_positions, motion.root_positions),
    )


def _fit_window(motion: Motion, positions: Array, weights: Array, progress: Progress) -> Motion:
    followed = [joint for joint in range(motion.n_joints) if weights[:, joint].any()]
    turning = _turning_joints(motion, followed)
    if not turning:
        return motion
    start = FittedMotion(motion, motion, tuple(turning))
    goals: list[Goal] = [
        FollowPosition(
            BonePoint(joint, np.zeros(3)),
            positions[:, joint],
            np.repeat(weights[:, joint, None], 3, axis=1),
            POSITION_M,
        )
        for joint in followed
    ]
    tolerances = dict.fromkeys(turning, ROTATION_RAD)
    goals.append(FollowSource.of_joints(start, ROTATION_RAD, tolerances, FADE_S))
    return fit_motion(start, goals, progress, "Fitting the skeleton").motion


def _turning_joints(motion: Motion, followed: Sequence[int]) -> list[int]:
    """Return the joints above others that have an observed position."""
    above = {each for joint in followed for each in motion.skeleton.ancestors(joint)}
    return sorted(above)
