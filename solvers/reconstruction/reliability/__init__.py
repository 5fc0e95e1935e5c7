"""Reliability of each tracked joint, frame by frame."""

from .left_right_swaps import fix_left_right_swaps
from .scores import Reliability, measure_reliability, posture_reliability
from .settings import ReliabilityMethod, ReliabilitySettings

__all__ = [
    "Reliability",
    "ReliabilityMethod",
    "ReliabilitySettings",
    "fix_left_right_swaps",
    "measure_reliability",
    "posture_reliability",
]
