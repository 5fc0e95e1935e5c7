"""The vocabulary that all families share: skeletons, motions, tracks and their geometry.

>>> import numpy as np
>>> from solvers.motion import Motion, Skeleton, forward_kinematics
>>> arm = Skeleton(("shoulder", "elbow"), (-1, 0), np.array([[0, 0, 1.4], [0.3, 0, 0]]))
>>> still = Motion(arm, np.tile([1.0, 0, 0, 0], (2, 2, 1)), np.tile([0, 0, 1.4], (2, 1)), 30.0)
>>> forward_kinematics(still).positions[0, 1].tolist()
[0.3, 0.0, 1.4]
"""

from .canonical import canonical_rotations, from_canonical, t_pose_alignment
from .humanoid import HUMANOID_ROLES, HumanoidMap, find_humanoid_map
from .kinematics import WorldPoses, forward_kinematics, local_rotations, world_poses
from .motion import Motion
from .skeleton import Skeleton
from .tracks import Tracks

__all__ = [
    "HUMANOID_ROLES",
    "HumanoidMap",
    "Motion",
    "Skeleton",
    "Tracks",
    "WorldPoses",
    "canonical_rotations",
    "find_humanoid_map",
    "forward_kinematics",
    "from_canonical",
    "local_rotations",
    "t_pose_alignment",
    "world_poses",
]
