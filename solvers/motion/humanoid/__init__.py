"""The human body on any skeleton: humanoid roles, rest poses, postures and foot contacts."""

from .body_parts import BODY_PARTS, joint_parts
from .body_size import (
    ADULT_BONE_LENGTHS_M,
    ADULT_STATURE_M,
    MAX_BODY_SCALE,
    MIN_BODY_SCALE,
    MIN_RELIABILITY,
    MIN_RELIABLE_FRAMES,
    estimate_body_scale,
    estimate_bone_lengths,
    resize_postures,
    segment_lengths,
)
from .bone_directions import (
    PARENT_INDICES,
    bone_directions,
    positions_from_directions,
    rates_from_directions,
)
from .bone_lengths import fit_bone_lengths, transfer_motion
from .canonical import FORWARD, UP, canonical_rotations, from_canonical, t_pose_alignment
from .foot_contacts import (
    HUMAN_LEG_LENGTH_M,
    ContactSettings,
    contacts_of_points,
    detect_contacts,
    foot_points,
    leg_length,
    without_short_runs,
)
from .missing_hips import UPPER_LEG_ROLES, fill_missing_hips
from .names import naming_scheme, roles_by_name
from .points_motion import motion_from_points
from .points_skeleton import skeleton_from_points
from .posture_heading import (
    HALF_LATERAL_JOINTS,
    LATERAL_JOINTS,
    NormalizedPostures,
    PostureNormalizer,
    mirror_postures,
    normalize_postures,
    rotate_about_vertical,
)
from .posture_joints import (
    CHEST,
    HIPS,
    MIRROR_JOINTS,
    N_JOINTS,
    PARENTS,
    POSTURE_JOINTS,
    SIDES,
    SPINE,
    posture_joint_indices,
    posture_positions,
    postures_from_motion,
)
from .presets import read_humanoid_map, write_humanoid_map
from .role_evidence import (
    MIN_CONFIDENCE,
    Reason,
    RoleEvidence,
    describe_low_confidence,
    evidence_figures,
    explain_roles,
)
from .roles import ESSENTIAL_ROLES, HUMANOID_ROLES, HumanoidMap, find_humanoid_map
from .standing_rest import with_standing_rest

__all__ = [
    "ADULT_BONE_LENGTHS_M",
    "ADULT_STATURE_M",
    "BODY_PARTS",
    "CHEST",
    "ESSENTIAL_ROLES",
    "FORWARD",
    "HALF_LATERAL_JOINTS",
    "HIPS",
    "HUMANOID_ROLES",
    "HUMAN_LEG_LENGTH_M",
    "LATERAL_JOINTS",
    "MAX_BODY_SCALE",
    "MIN_BODY_SCALE",
    "MIN_CONFIDENCE",
    "MIN_RELIABILITY",
    "MIN_RELIABLE_FRAMES",
    "MIRROR_JOINTS",
    "N_JOINTS",
    "PARENTS",
    "PARENT_INDICES",
    "POSTURE_JOINTS",
    "SIDES",
    "SPINE",
    "UP",
    "UPPER_LEG_ROLES",
    "ContactSettings",
    "HumanoidMap",
    "NormalizedPostures",
    "PostureNormalizer",
    "Reason",
    "RoleEvidence",
    "bone_directions",
    "canonical_rotations",
    "contacts_of_points",
    "describe_low_confidence",
    "detect_contacts",
    "estimate_body_scale",
    "estimate_bone_lengths",
    "evidence_figures",
    "explain_roles",
    "fill_missing_hips",
    "find_humanoid_map",
    "fit_bone_lengths",
    "foot_points",
    "from_canonical",
    "joint_parts",
    "leg_length",
    "mirror_postures",
    "motion_from_points",
    "naming_scheme",
    "normalize_postures",
    "positions_from_directions",
    "posture_joint_indices",
    "posture_positions",
    "postures_from_motion",
    "rates_from_directions",
    "read_humanoid_map",
    "resize_postures",
    "roles_by_name",
    "rotate_about_vertical",
    "segment_lengths",
    "skeleton_from_points",
    "t_pose_alignment",
    "transfer_motion",
    "with_standing_rest",
    "without_short_runs",
    "write_humanoid_map",
]
