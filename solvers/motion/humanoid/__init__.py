"""The human body on any skeleton: roles of joints, rest poses, standard postures, contacts."""

from .body_size import (
    FEWEST,
    LARGEST,
    RELIABLE,
    SMALLEST,
    STATURE,
    USUAL_LENGTHS,
    body_lengths,
    resize,
    segment_lengths,
    size_of_body,
)
from .bone_directions import ABOVE, along_bones, bone_changes, bone_directions
from .bone_lengths import fit_bone_lengths, transfer_motion
from .canonical import FORWARD, UP, canonical_rotations, from_canonical, t_pose_alignment
from .contacts import (
    HUMAN_LEG,
    ContactSettings,
    contacts_of_points,
    detect_contacts,
    foot_points,
    leg_length,
)
from .missing_hips import LEGS, with_hips
from .names import roles_by_name
from .points_motion import motion_from_points
from .points_skeleton import skeleton_from_points
from .posture_heading import ACROSS, Normalised, mirrored, normalise, turned
from .posture_joints import (
    CHEST,
    HIPS,
    MIRROR_IMAGES,
    N_JOINTS,
    PARENTS,
    POSTURE_JOINTS,
    SIDES,
    SPINE,
    joints_of_names,
    motion_postures,
    posture_positions,
)
from .presets import read_humanoid_map, write_humanoid_map
from .roles import ESSENTIAL_ROLES, HUMANOID_ROLES, HumanoidMap, find_humanoid_map

__all__ = [
    "ABOVE",
    "ACROSS",
    "CHEST",
    "ESSENTIAL_ROLES",
    "FEWEST",
    "FORWARD",
    "HIPS",
    "HUMANOID_ROLES",
    "HUMAN_LEG",
    "LARGEST",
    "LEGS",
    "MIRROR_IMAGES",
    "N_JOINTS",
    "PARENTS",
    "POSTURE_JOINTS",
    "RELIABLE",
    "SIDES",
    "SMALLEST",
    "SPINE",
    "STATURE",
    "UP",
    "USUAL_LENGTHS",
    "ContactSettings",
    "HumanoidMap",
    "Normalised",
    "along_bones",
    "body_lengths",
    "bone_changes",
    "bone_directions",
    "canonical_rotations",
    "contacts_of_points",
    "detect_contacts",
    "find_humanoid_map",
    "fit_bone_lengths",
    "foot_points",
    "from_canonical",
    "joints_of_names",
    "leg_length",
    "mirrored",
    "motion_from_points",
    "motion_postures",
    "normalise",
    "posture_positions",
    "read_humanoid_map",
    "resize",
    "roles_by_name",
    "segment_lengths",
    "size_of_body",
    "skeleton_from_points",
    "t_pose_alignment",
    "transfer_motion",
    "turned",
    "with_hips",
    "write_humanoid_map",
]
