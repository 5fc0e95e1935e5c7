"""Rebuild clean poses from what a depth camera's tracker saw."""

from .posture_library import (
    PostureLibrary,
    PostureLibrarySettings,
    build_posture_library,
    load_posture_library,
)
from .posture_settings import PostureMethod, PostureSettings
from .reconstruct_postures import reconstruct_postures
from .reliability import Reliability, measure_reliability
from .reliability_markers import measure_marker_reliability
from .reliability_settings import ReliabilityMethod, ReliabilitySettings
from .result import Reconstruction

__all__ = [
    "PostureLibrary",
    "PostureLibrarySettings",
    "PostureMethod",
    "PostureSettings",
    "Reconstruction",
    "Reliability",
    "ReliabilityMethod",
    "ReliabilitySettings",
    "build_posture_library",
    "load_posture_library",
    "measure_marker_reliability",
    "measure_reliability",
    "reconstruct_postures",
]
