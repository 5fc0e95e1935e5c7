"""The vocabulary that all families share: skeletons, motions, tracks and their geometry.

>>> import numpy as np
>>> from solvers.motion import Motion, Skeleton, forward_kinematics
>>> arm = Skeleton(("shoulder", "elbow"), (-1, 0), np.array([[0, 0, 1.4], [0.3, 0, 0]]))
>>> still = Motion(arm, np.tile([1.0, 0, 0, 0], (2, 2, 1)), np.tile([0, 0, 1.4], (2, 1)), 30.0)
>>> forward_kinematics(still).positions[0, 1].tolist()
[0.3, 0.0, 1.4]
"""

from .humanoid import (
    HUMANOID_ROLES,
    ContactSettings,
    HumanoidMap,
    canonical_rotations,
    contacts_of_points,
    detect_contacts,
    find_humanoid_map,
    fit_bone_lengths,
    foot_points,
    from_canonical,
    leg_length,
    motion_from_points,
    read_humanoid_map,
    roles_by_name,
    skeleton_from_points,
    t_pose_alignment,
    transfer_motion,
    write_humanoid_map,
)
from .skeletons import (
    SENSOR_JOINTS,
    Alignment,
    JointLimits,
    JointRecording,
    Motion,
    ReachSettings,
    Sensor,
    Skeleton,
    Tracks,
    WorldPoses,
    forward_kinematics,
    joint_parents,
    linear_velocities,
    local_rotations,
    reach,
    resample,
    warp,
    world_poses,
)

__all__ = [
    "HUMANOID_ROLES",
    "SENSOR_JOINTS",
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
