"""The human body on any skeleton: humanoid roles, rest poses, postures and foot contacts."""

from typing import TYPE_CHECKING

from ...import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .body_parts import BODY_PARTS, joint_parts
    from .body_size import (
        ADULT_BONE_LENGTHS_M,
        ADULT_STATURE_M,
        MAX_BODY_SCALE,
        MIN_BODY_SCALE,
        MIN_JOINT_RELIABILITY,
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
    from .bone_lengths import transfer_motion
    from .canonical import (
        FORWARD,
        UP,
        ball_of_foot,
        canonical_rotations,
        end_of_foot,
        from_canonical,
        prolongs_shin,
        t_pose_alignment,
    )
    from .foot_contacts import (
        CONTACT_MODEL,
        HUMAN_LEG_LENGTH_M,
        SPEED_NOISE,
        ContactModel,
        FeetInMotion,
        contact_probabilities,
        contacts_of_points,
        detect_contacts,
        foot_noise,
        foot_points,
        known_foot_points,
        leg_length,
        measure_feet,
        probabilities_of_points,
    )
    from .missing_hips import UPPER_LEG_ROLES, fill_missing_hips
    from .names import SIDE_OF_WORD, naming_scheme, roles_by_name
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
    from .tables import ARM_ROLES, CENTRAL_ROLES, LEG_ROLES, SIDES

__all__ = [
    "ADULT_BONE_LENGTHS_M",
    "ADULT_STATURE_M",
    "ARM_ROLES",
    "BODY_PARTS",
    "CENTRAL_ROLES",
    "CHEST",
    "CONTACT_MODEL",
    "ESSENTIAL_ROLES",
    "FORWARD",
    "HALF_LATERAL_JOINTS",
    "HIPS",
    "HUMANOID_ROLES",
    "HUMAN_LEG_LENGTH_M",
    "LATERAL_JOINTS",
    "LEG_ROLES",
    "MAX_BODY_SCALE",
    "MIN_BODY_SCALE",
    "MIN_CONFIDENCE",
    "MIN_JOINT_RELIABILITY",
    "MIN_RELIABLE_FRAMES",
    "MIRROR_JOINTS",
    "N_JOINTS",
    "PARENTS",
    "PARENT_INDICES",
    "POSTURE_JOINTS",
    "SIDES",
    "SIDE_OF_WORD",
    "SPEED_NOISE",
    "SPINE",
    "UP",
    "UPPER_LEG_ROLES",
    "ContactModel",
    "FeetInMotion",
    "HumanoidMap",
    "NormalizedPostures",
    "PostureNormalizer",
    "Reason",
    "RoleEvidence",
    "ball_of_foot",
    "bone_directions",
    "canonical_rotations",
    "contact_probabilities",
    "contacts_of_points",
    "describe_low_confidence",
    "detect_contacts",
    "end_of_foot",
    "estimate_body_scale",
    "estimate_bone_lengths",
    "evidence_figures",
    "explain_roles",
    "fill_missing_hips",
    "find_humanoid_map",
    "foot_noise",
    "foot_points",
    "from_canonical",
    "joint_parts",
    "known_foot_points",
    "leg_length",
    "measure_feet",
    "mirror_postures",
    "motion_from_points",
    "naming_scheme",
    "normalize_postures",
    "positions_from_directions",
    "posture_joint_indices",
    "posture_positions",
    "postures_from_motion",
    "probabilities_of_points",
    "prolongs_shin",
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
    "write_humanoid_map",
]

import_on_demand(__name__)
