"""Joint limits: learned from clean motion, and enforced."""

from .clamp_to_limits import clamp_to_limits, limit_excess
from .impossible_rotations import impossible_turns
from .learn_limits import JointLimitsSettings, learn_joint_limits

__all__ = [
    "JointLimitsSettings",
    "clamp_to_limits",
    "impossible_turns",
    "learn_joint_limits",
    "limit_excess",
]
