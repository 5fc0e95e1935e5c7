"""Bodies of SMPL, SMPL-H and SMPL-X: joints, rotations, and arrays of several people."""

from .easymocap import with_root_at_pelvis
from .joints import BODY, FINGERS, smpl_joints
from .parameters import (
    ALL_ROTATIONS,
    BODY_SCALES,
    N_BODY,
    N_HAND,
    N_WITH_COMPONENTS,
    NAMES,
    OF_CAMERA,
    OF_SMPL,
    POSES,
    POSITIONS,
    RATES,
    READ_ARRAYS,
    ROOT,
    ROTATIONS,
    SCALES,
    SIZES,
    member,
    plain_name,
    rotation_vectors,
    spelled,
)
from .people import split_people
from .rotations import with_rotation_vectors

__all__ = [
    "ALL_ROTATIONS",
    "BODY",
    "BODY_SCALES",
    "FINGERS",
    "NAMES",
    "N_BODY",
    "N_HAND",
    "N_WITH_COMPONENTS",
    "OF_CAMERA",
    "OF_SMPL",
    "POSES",
    "POSITIONS",
    "RATES",
    "READ_ARRAYS",
    "ROOT",
    "ROTATIONS",
    "SCALES",
    "SIZES",
    "member",
    "plain_name",
    "rotation_vectors",
    "smpl_joints",
    "spelled",
    "split_people",
    "with_root_at_pelvis",
    "with_rotation_vectors",
]
