"""The vocabulary that all families share: skeletons, motions, tracks and their geometry.

>>> import numpy as np
>>> from solvers.motion import Motion, Skeleton, forward_kinematics
>>> arm = Skeleton(("shoulder", "elbow"), (-1, 0), np.array([[0, 0, 1.4], [0.3, 0, 0]]))
>>> still = Motion(arm, np.tile([1.0, 0, 0, 0], (2, 2, 1)), np.tile([0, 0, 1.4], (2, 1)), 30.0)
>>> forward_kinematics(still).positions[0, 1].tolist()
[0.3, 0.0, 1.4]
"""

from typing import TYPE_CHECKING

from ..import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .humanoid import (
        BODY_PARTS,
        HUMANOID_ROLES,
        HumanoidMap,
        Reason,
        RoleEvidence,
        canonical_rotations,
        contact_probabilities,
        contacts_of_points,
        describe_low_confidence,
        detect_contacts,
        evidence_figures,
        explain_roles,
        find_humanoid_map,
        foot_points,
        from_canonical,
        joint_parts,
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
        AxisName,
        FileConventions,
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
        local_rotations,
        reach,
        resample,
        unit_name,
        warp,
        world_poses,
    )

__all__ = [
    "BODY_PARTS",
    "HUMANOID_ROLES",
    "SENSOR_JOINTS",
    "Alignment",
    "AxisName",
    "FileConventions",
    "HumanoidMap",
    "JointLimits",
    "JointRecording",
    "Motion",
    "ReachSettings",
    "Reason",
    "RoleEvidence",
    "Sensor",
    "Skeleton",
    "Tracks",
    "WorldPoses",
    "canonical_rotations",
    "contact_probabilities",
    "contacts_of_points",
    "describe_low_confidence",
    "detect_contacts",
    "evidence_figures",
    "explain_roles",
    "find_humanoid_map",
    "foot_points",
    "forward_kinematics",
    "from_canonical",
    "joint_parents",
    "joint_parts",
    "leg_length",
    "local_rotations",
    "motion_from_points",
    "reach",
    "read_humanoid_map",
    "resample",
    "roles_by_name",
    "skeleton_from_points",
    "t_pose_alignment",
    "transfer_motion",
    "unit_name",
    "warp",
    "world_poses",
    "write_humanoid_map",
]

import_on_demand(__name__)
