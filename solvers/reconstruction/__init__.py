"""Rebuild clean poses from what a depth camera's tracker saw."""

from .reliability import Reliability, measure_reliability
from .reliability_markers import measure_marker_reliability
from .reliability_settings import ReliabilityMethod, ReliabilitySettings

__all__ = [
    "Reliability",
    "ReliabilityMethod",
    "ReliabilitySettings",
    "measure_marker_reliability",
    "measure_reliability",
]
