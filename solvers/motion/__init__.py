"""The vocabulary that all families share: skeletons, motions, tracks and their geometry.

>>> import numpy as np
>>> from solvers.motion import Motion, Skeleton, forward_kinematics
>>> arm = Skeleton(("shoulder", "elbow"), (-1, 0), np.array([[0, 0, 1.4], [0.3, 0, 0]]))
>>> still = Motion(arm, np.tile([1.0, 0, 0, 0], (2, 2, 1)), np.tile([0, 0, 1.4], (2, 1)), 30.0)
>>> forward_kinematics(still).positions[0, 1].tolist()
[0.3, 0.0, 1.4]
"""

from .bone_lengths import fit_bone_lengths, transfer_motion
from .canonical import canonical_rotations, from_canonical, t_pose_alignment
from .contacts import (
    ContactSettings,
    contacts_of_points,
    detect_contacts,
    foot_points,
    leg_length,
)
from .depth_sensors import JOINTS, Sensor, joint_parents
from .humanoid import HUMANOID_ROLES, HumanoidMap, find_humanoid_map
from .humanoid_names import roles_by_name
from .humanoid_presets import read_humanoid_map, write_humanoid_map
from .joint_limits import JointLimits, load_joint_limits
from .joint_recording import JointRecording
from .kinematics import WorldPoses, forward_kinematics, local_rotations, world_poses
from .limb_ik import ReachSettings, reach
from .motion import Motion
from .points_motion import motion_from_points
from .points_skeleton import skeleton_from_points
from .resampling import resample
from .skeleton import Skeleton
from .tracks import Tracks
from .velocities import angular_velocities, linear_velocities
from .warping import Alignment, warp

__all__ = [
    "HUMANOID_ROLES",
    "JOINTS",
    "Alignment",
    "ContactSettings",
    "HumanoidMap",
    "JointLimits",
    "JointRecording",
    "Motion",
    "ReachSettings",
    "Sensor",
    "Skeleton",
    "Tracks",
    "WorldPoses",
    "angular_velocities",
    "canonical_rotations",
    "contacts_of_points",
    "detect_contacts",
    "find_humanoid_map",
    "fit_bone_lengths",
    "foot_points",
    "forward_kinematics",
    "from_canonical",
    "joint_parents",
    "leg_length",
    "linear_velocities",
    "load_joint_limits",
    "local_rotations",
    "motion_from_points",
    "reach",
    "read_humanoid_map",
    "resample",
    "roles_by_name",
    "skeleton_from_points",
    "t_pose_alignment",
    "transfer_motion",
    "warp",
    "world_poses",
    "write_humanoid_map",
]
