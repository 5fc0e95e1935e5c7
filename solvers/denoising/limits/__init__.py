"""Joint limits: learned from clean motion, and enforced."""

from .impossible_rotations import impossible_turns
from .keep_within import keep_within, limit_excess
from .learn_limits import JointLimitsSettings, learn_joint_limits

__all__ = [
    "JointLimitsSettings",
    "impossible_turns",
    "keep_within",
    "learn_joint_limits",
    "limit_excess",
]
