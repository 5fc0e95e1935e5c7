"""Frames of streams that send rotations of bones: VMC, mocopi, Rokoko and Xsens."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ....arrays import Array
from ....motion import Motion, Skeleton, find_humanoid_map, forward_kinematics
from ...conventions import ConstantRate
from .joint_frames import LiveFrame


@dataclass(frozen=True, eq=False)
class PoseFrame:
    """One posed skeleton at one time.

    Attributes
    ----------
    time : float, seconds, of the sender's clock
    body : int
        Identifies the body among those that are tracked.
    skeleton : Skeleton
        The same object as long as the body does not change.
    rotations : shape (n_joints, 4)
        Local, w x y z, identity in the rest pose.
    root_position : shape (3,), meters
    """

    time: float
    body: int
    skeleton: Skeleton
    rotations: Array
    root_position: Array

    @property
    def names(self) -> tuple[str, ...]:
        """The joints."""
        return self.skeleton.names


def motion_from_poses(frames: Sequence[PoseFrame], frame_rate: float) -> Motion:
    """Return frames of one skeleton as a motion, one after the other."""
    return Motion(
        frames[0].skeleton,
        np.stack([frame.rotations for frame in frames]),
        np.stack([frame.root_position for frame in frames]),
        frame_rate,
    )


def measured_rate(frames: Sequence[PoseFrame]) -> float:
    """Return the frame rate in hertz, or a common rate next to it.

    Raises
    ------
    InvalidFileError
        The times do not increase.
    """
    return ConstantRate("The stream", np.array([frame.time for frame in frames])).frame_rate


def joints_from_pose(frame: PoseFrame) -> LiveFrame:
    """Return the positions of the joints that play humanoid roles, named by these."""
    joints = _joints_by_role(frame.skeleton)
    positions = forward_kinematics(motion_from_poses([frame], 1.0)).positions[0]
    return LiveFrame(
        frame.time, frame.body, tuple(joints), positions[list(joints.values())],
        np.ones(len(joints)),
    )  # fmt: skip


@lru_cache(maxsize=8)
def _joints_by_role(skeleton: Skeleton) -> dict[str, int]:
    return find_humanoid_map(skeleton).indices(skeleton)
