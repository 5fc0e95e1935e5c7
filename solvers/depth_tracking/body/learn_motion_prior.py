"""Learn from recorded motions which poses follow which."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...motion import Motion, find_humanoid_map, forward_kinematics, resample
from ...progress import Progress, unwatched, within
from .model import default_body
from .motion import SCENE_FROM_CAMERA
from .motion_prior import MotionPrior, motion_prior_from_poses
from .pose_from_joints import body_from_joints, pose_from_joints
from .tables import JOINTS

Array = NDArray[np.float64]

FRAME_RATE = 30.0
"""Poses per second that are learned: that of depth cameras."""
_NEEDED = ("hips", "leftUpperLeg", "rightUpperLeg", "leftUpperArm", "rightUpperArm")
_TURNS, _FIRST_TURNS = 8, 40
"""Steps of the search from the frame before, and in the first frame."""


def learn_motion_prior(
    motions: Sequence[Motion], *, trained_on: str = "", progress: Progress = unwatched
) -> MotionPrior:
    """Return a prior of the poses of recorded motions, for `track_pose` and `capture`.

    The body model is posed after the joints of each frame, at 30 Hz, so that any humanoid
    skeleton will do [LOU12]_, section 3.5.

    Parameters
    ----------
    motions : sequence of Motion
        Clean humanoid motions.
    trained_on : str
        Kept with the prior: which motions these are.
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
    for place, motion in enumerate(motions):
        done = within(progress, place / len(motions), (place + 1) / len(motions))
        sequences.append(poses_from_motion(motion, done))
    return motion_prior_from_poses(sequences, trained_on)


def poses_from_motion(motion: Motion, progress: Progress = unwatched) -> Array:
    """Return the poses (n_frames, 36) of a body model that moves like this motion, at 30 Hz.

    Frames that were not wholly observed are left out.
    """
    joints = camera_joints(motion)
    joints = joints[np.isfinite(joints).any(axis=(1, 2))]
    known = np.isfinite(joints).all(axis=2)
    joints = joints[(known == known.any(axis=0)).all(axis=1)]
    if not len(joints):
        raise InvalidMotionError("No frame of a motion is complete; fill its gaps first.")
    body = body_from_joints(default_body(), joints)
    poses: list[Array] = []
    for frame, places in enumerate(joints):
        start = poses[-1] if poses else None
        turns = _TURNS if poses else _FIRST_TURNS
        poses.append(pose_from_joints(body, places, start=start, iterations=turns))
        progress((frame + 1) / len(joints), "Learning poses")
    return np.array(poses)


def camera_joints(motion: Motion) -> Array:
    """Return the `JOINTS` (n_frames, 21, 3) of a motion before a level camera, at 30 Hz."""
    roles = find_humanoid_map(motion.skeleton)
    missing = [role for role in _NEEDED if not roles.has(role)]
    if missing:
        raise InvalidMotionError(
            f"A skeleton has no joint for: {', '.join(missing)}. Choose humanoid motions."
        )
    if motion.n_frames > 1:
        motion = resample(motion, FRAME_RATE)
    world = forward_kinematics(motion).positions @ SCENE_FROM_CAMERA
    places = roles.indices(motion.skeleton)
    joints = np.full((motion.n_frames, len(JOINTS), 3), np.nan)
    for joint, role in enumerate(JOINTS):
        if role in places and role not in _VAGUE:
            joints[:, joint] = world[:, places[role]]
    return joints


_VAGUE = frozenset({"spine", "chest", "leftShoulder", "rightShoulder"})
"""Skeletons disagree where these are."""
