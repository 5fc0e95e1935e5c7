"""Reliability of each tracked joint, frame by frame."""

from .left_right_swaps import fix_left_right_swaps
from .scores import (
    Reliability,
    expected_lengths,
    measure_reliability,
    memory_frames,
    posture_reliability,
)
from .settings import (
    OBSERVED_RELIABILITY,
    REPLACED_RELIABILITY,
    WRONG_RELIABILITY,
    ReliabilityMethod,
    ReliabilitySettings,
)

__all__ = [
    "OBSERVED_RELIABILITY",
    "REPLACED_RELIABILITY",
    "WRONG_RELIABILITY",
    "Reliability",
    "ReliabilityMethod",
    "ReliabilitySettings",
    "expected_lengths",
    "fix_left_right_swaps",
    "measure_reliability",
    "memory_frames",
    "posture_reliability",
]
