"""Joint rotations of a skeleton from the positions of its joints."""

from .fit_to_postures import fit_motion_to_postures
from .library_body import (
    HALF_WEIGHT_COUNT,
    BodyPostures,
    bone_axis_corrections,
    build_body_postures,
)
from .limb_angles import Complex, axial_angles
from .limb_twist import flexion_weights
from .motion_from_positions import motion_from_positions, resize_skeleton
from .other_joints import (
    JointOffsets,
    find_anchors,
    measure_joint_offsets,
    positions_from_postures,
)
from .result import Reconstruction
from .trunk_twist import (
    N_TWISTED_LIMBS,
    TWISTED_LIMBS,
    LimbTwists,
    flexion_normals,
    mean_twists,
    mirror_twists,
    untwisted_hinges,
)

__all__ = [
    "HALF_WEIGHT_COUNT",
    "N_TWISTED_LIMBS",
    "TWISTED_LIMBS",
    "BodyPostures",
    "Complex",
    "JointOffsets",
    "LimbTwists",
    "Reconstruction",
    "axial_angles",
    "bone_axis_corrections",
    "build_body_postures",
    "find_anchors",
    "fit_motion_to_postures",
    "flexion_normals",
    "flexion_weights",
    "mean_twists",
    "measure_joint_offsets",
    "mirror_twists",
    "motion_from_positions",
    "positions_from_postures",
    "resize_skeleton",
    "untwisted_hinges",
]
