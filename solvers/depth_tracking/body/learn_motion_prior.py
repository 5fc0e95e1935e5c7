"""Learn the motion prior from recorded motions."""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array
from ...errors import InvalidMotionError
from ...motion import Motion, find_humanoid_map, forward_kinematics, resample
from ...progress import Progress, unwatched, within
from .model import default_body
from .motion import SCENE_FROM_CAMERA
from .motion_prior import MotionPrior, motion_prior_from_poses
from .pose_from_joints import body_from_joints, pose_from_joints
from .tables import JOINTS

FRAME_RATE_HZ = 30.0
"""Frame rate of the learned poses: that of depth cameras. By definition."""
_REQUIRED_ROLES = ("hips", "leftUpperLeg", "rightUpperLeg", "leftUpperArm", "rightUpperArm")
_ITERATIONS, _FIRST_ITERATIONS = 8, 40
"""Solver iterations from the previous pose, and in the first frame."""


def learn_motion_prior(
    motions: Sequence[Motion], *, trained_on: str = "", progress: Progress = unwatched
) -> MotionPrior:
    """Learn a motion prior from recorded motions, for `track_pose` and `capture`.

    The body model is fitted to the joints of each frame at 30 Hz, so any humanoid skeleton
    works [LOU12]_, section 3.5.

    Parameters
    ----------
    motions : sequence of Motion
        Clean humanoid motions.
    trained_on : str
        Description of the motions, stored with the prior.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        There is no motion, or a skeleton lacks hips, legs or arms.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [LOU12] Lou (2012). Acquiring 3D full-body motion from noisy and ambiguous input. PhD
       dissertation, Texas A&M University.
    """
    sequences = []
    for index, motion in enumerate(motions):
        motion_progress = within(progress, index / len(motions), (index + 1) / len(motions))
        sequences.append(poses_from_motion(motion, motion_progress))
    return motion_prior_from_poses(sequences, trained_on)


def poses_from_motion(motion: Motion, progress: Progress = unwatched) -> Array:
    """Return the poses (n_frames, 36) of a body model fitted to a motion, at 30 Hz.

    Incomplete frames are skipped.
    """
    joints = camera_joints(motion)
    joints = joints[np.isfinite(joints).any(axis=(1, 2))]
    observed = np.isfinite(joints).all(axis=2)
    joints = joints[(observed == observed.any(axis=0)).all(axis=1)]
    if not len(joints):
        raise InvalidMotionError("No frame of a motion is complete; fill its gaps first.")
    body = body_from_joints(default_body(), joints)
    poses: list[Array] = []
    for frame, positions in enumerate(joints):
        start = poses[-1] if poses else None
        iterations = _ITERATIONS if poses else _FIRST_ITERATIONS
        poses.append(pose_from_joints(body, positions, start=start, iterations=iterations))
        progress((frame + 1) / len(joints), "Learning poses")
    return np.array(poses)


def camera_joints(motion: Motion) -> Array:
    """Return the `JOINTS` (n_frames, 21, 3) of a motion in front of a level camera, 30 Hz."""
    roles = find_humanoid_map(motion.skeleton)
    missing = [role for role in _REQUIRED_ROLES if not roles.has(role)]
    if missing:
        raise InvalidMotionError(
            f"A skeleton has no joint for: {', '.join(missing)}. Choose humanoid motions."
        )
    if motion.n_frames > 1:
        motion = resample(motion, FRAME_RATE_HZ)
    world = forward_kinematics(motion).positions @ SCENE_FROM_CAMERA
    joint_of_role = roles.indices(motion.skeleton)
    joints = np.full((motion.n_frames, len(JOINTS), 3), np.nan)
    for joint, role in enumerate(JOINTS):
        if role in joint_of_role and role not in _INCONSISTENT_ROLES:
            joints[:, joint] = world[:, joint_of_role[role]]
    return joints


_INCONSISTENT_ROLES = frozenset({"spine", "chest", "leftShoulder", "rightShoulder"})
"""Skeletons define the positions of these joints inconsistently."""
