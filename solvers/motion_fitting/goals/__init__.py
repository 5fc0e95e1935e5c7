"""What a fitted motion is to meet, one kind of goal in each file."""

from .bone_rotations import FollowRotation, StayStill
from .contact_points import BonePoint, FollowPosition, StayAtHeight, StayInPlace
from .follow_source import FollowSource
from .hinge_limit import HingeLimit, hinge_axis, hinge_flexion

__all__ = [
    "BonePoint",
    "FollowPosition",
    "FollowRotation",
    "FollowSource",
    "HingeLimit",
    "StayAtHeight",
    "StayInPlace",
    "StayStill",
    "hinge_axis",
    "hinge_flexion",
]
