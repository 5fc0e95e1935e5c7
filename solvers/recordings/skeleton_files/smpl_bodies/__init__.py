"""Bodies of SMPL, SMPL-H and SMPL-X: joints, rotations, and arrays of several people."""

from .easymocap import with_root_at_pelvis
from .joints import BODY, FINGERS, smpl_joints
from .people import split_people
from .rotations import with_rotation_vectors

__all__ = [
    "BODY",
    "FINGERS",
    "smpl_joints",
    "split_people",
    "with_root_at_pelvis",
    "with_rotation_vectors",
]
