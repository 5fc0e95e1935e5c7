"""The goals of a fitted motion, one kind in each file."""

from .bone_rotations import FollowRotation, StayStill
from .contact_points import (
    BonePoint,
    FollowPosition,
    KeepSeparation,
    StayAbove,
    StayAtHeight,
    StayInPlace,
)
from .follow_source import FollowSource
from .hinge_limit import (
    MIN_BEND,
    HingeLimit,
    bone_directions,
    flexion_in_reserve,
    hinge_axis,
    hinge_flexion,
    hinge_limit,
    knee_limit,
    with_bent_hinge,
)

__all__ = [
    "MIN_BEND",
    "BonePoint",
    "FollowPosition",
    "FollowRotation",
    "FollowSource",
    "HingeLimit",
    "KeepSeparation",
    "StayAbove",
    "StayAtHeight",
    "StayInPlace",
    "StayStill",
    "bone_directions",
    "flexion_in_reserve",
    "hinge_axis",
    "hinge_flexion",
    "hinge_limit",
    "knee_limit",
    "with_bent_hinge",
]
