"""Bodies of SMPL, SMPL-H and SMPL-X: joints, rotations, and arrays of several people."""

from .bodies import VIDEO_UP, bodies_of_parameters
from .joints import BODY, smpl_joints
from .parameters import (
    BODY_SCALES,
    N_BODY,
    N_BODY_POSE,
    N_HAND,
    N_NUMBERS,
    NAMES,
    OF_SMPL,
    POSES,
    RATES,
    READ_ARRAYS,
    ROOT,
    ROTATIONS,
    SCALES,
    plain_name,
)
from .people import people_of_parameters, split_people
from .rows import CONSTANT, joined_frames, rows_of_frames

__all__ = [
    "BODY",
    "BODY_SCALES",
    "CONSTANT",
    "NAMES",
    "N_BODY",
    "N_BODY_POSE",
    "N_HAND",
    "N_NUMBERS",
    "OF_SMPL",
    "POSES",
    "RATES",
    "READ_ARRAYS",
    "ROOT",
    "ROTATIONS",
    "SCALES",
    "VIDEO_UP",
    "bodies_of_parameters",
    "joined_frames",
    "people_of_parameters",
    "plain_name",
    "rows_of_frames",
    "smpl_joints",
    "split_people",
]
