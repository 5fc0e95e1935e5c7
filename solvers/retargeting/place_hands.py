"""Retarget hands: relative to the shoulders, to the ground, and to each other."""

from collections.abc import Sequence

import numpy as np

from ..arrays import Array
from ..motion import Motion, WorldPoses, forward_kinematics
from ..motion_fitting import FittedMotion, Goal, fit_in_windows, fit_motion
from ..motion_fitting.goals import (
    BonePoint,
    FollowPosition,
    FollowSource,
    KeepSeparation,
    StayAbove,
    hinge_limit,
    with_bent_hinge,
)
from ..progress import Progress, unwatched
from ..rotations import inverse, multiply
from .hand_paths import HandPath, find_hand_paths, find_meeting
from .hinges import limb_hinge
from .limbs import BLEND_S, Transfer

HAND_FRACTION = 0.02
"""Arm lengths by which hands may leave their paths. X2 lets hands that support the body slide.
Half and twice are no better (`make sensitivity`)."""
EXACT_FRACTION = 0.002
"""Arm lengths by which hands that meet may be off their distance, and wrists below their least
height. It guards hands that clap, which would stay apart on broad shoulders, and those of a
body that lies down, which would sink lower than the source's
(`test_hands_that_meet_in_the_source_meet`)."""
ARM_RAD = np.radians(20.0)
"""Radians by which shoulders and elbows may turn. Half and twice are no better
(`make sensitivity`)."""
RESERVE_RAD = np.radians(5.0)
"""Radians of flexion kept in an elbow, unless it is straighter already. It guards arms that
reach for what is too far, which would snap straight
(`test_arms_too_short_for_hands_to_meet_do_not_snap`)."""
ELBOW_AXES = {"left": np.array([0.0, 0.0, -1.0]), "right": np.array([0.0, 0.0, 1.0])}
"""In the T-pose, in which forearms bend forward."""


def place_hands(
    transfer: Transfer,
    rotations: Array,
    root_positions: Array,
    progress: Progress = unwatched,
) -> Array:
    """Place the hands relative to the shoulders like the source's, scaled by the arm length.

    Hands near the ground keep their height above it, and their place if they support the body;
    hands that meet in the source keep their distance, scaled by the arms. The arms change as
    little and as smoothly as possible; the hands keep their rotation in the world.

    Parameters
    ----------
    transfer : Transfer
    rotations : shape (n_frames, n_joints, 4)
        Local rotations of the target.
    root_positions : shape (n_frames, 3), meters
        Positions of its topmost joint.
    progress : Progress

    Returns
    -------
    The rotations with new arms.
    """
    target = transfer.target
    motion = Motion(target.skeleton, rotations, root_positions, transfer.frame_rate)
    poses = forward_kinematics(motion)
    paths, meeting = find_hand_paths(transfer, poses), find_meeting(transfer)
    if not paths:
        return rotations
    joints = {joint: ARM_RAD for path in paths for joint in path.arm[:2]}

    def fit_window(start: int, stop: int, progress: Progress) -> Motion:
        window, frames = motion.slice(start, stop), slice(start, stop)
        recorded = FittedMotion(window, window, ())
        hinges = {
            path.arm[1]: limb_hinge(target, recorded, path.arm, ELBOW_AXES[path.side])
            for path in paths
        }
        fitted = FittedMotion(window, window, tuple(joints), root_moves=False, hinges=hinges)
        goals: list[Goal] = [FollowSource.of_joints(fitted, 1.0, joints, BLEND_S)]
        start_of_fit, everywhere = fitted, np.ones((stop - start, 3))
        for path in paths:
            hand = BonePoint(path.arm[2], np.zeros(3))
            goals.append(
                FollowPosition(
                    hand, path.wanted[frames], everywhere, HAND_FRACTION * path.length
                )
            )
            goals += [
                StayAbove(
                    BonePoint(joint, np.zeros(3)), height[frames], EXACT_FRACTION * path.length
                )
                for joint, height in zip(path.arm[1:], path.least_heights or (), strict=False)
            ]
            axis = hinges[path.arm[1]]
            elbow = hinge_limit(fitted, *path.arm[1:], axis, RESERVE_RAD)
            goals.append(elbow)
            start_of_fit = with_bent_hinge(start_of_fit, elbow)
        if meeting:
            left, right = (BonePoint(path.arm[2], np.zeros(3)) for path in paths)
            tolerance = EXACT_FRACTION * float(np.mean([path.length for path in paths]))
            wanted = meeting.wanted(*paths)[frames]
            weight = (meeting.weight[frames] > 0.0).astype(np.float64)
            goals.append(KeepSeparation(left, right, wanted, weight, tolerance))
        return fit_motion(start_of_fit, goals, progress, "Placing the hands").motion

    result = fit_in_windows(motion, fit_window, progress)
    return _with_rotated_hands(result, poses, paths)


def _with_rotated_hands(motion: Motion, before: WorldPoses, paths: Sequence[HandPath]) -> Array:
    """Return the local rotations with hands that are turned in the world as before."""
    rotations, after = motion.rotations.copy(), forward_kinematics(motion)
    for hand in (path.arm[2] for path in paths):
        parent = motion.skeleton.parents[hand]
        rotations[:, hand] = multiply(
            inverse(after.rotations[:, parent]), before.rotations[:, hand]
        )
    return rotations
