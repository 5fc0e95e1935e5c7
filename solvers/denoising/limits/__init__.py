"""Joint limits: learn them from clean motion, and enforce them."""

from .clamp_to_limits import clamp_to_limits, limit_excess
from .impossible_rotations import find_impossible_rotations
from .learn_limits import JointLimitsSettings, learn_joint_limits

__all__ = [
    "JointLimitsSettings",
    "clamp_to_limits",
    "find_impossible_rotations",
    "learn_joint_limits",
    "limit_excess",
]
