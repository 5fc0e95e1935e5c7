"""What joins families: whole ways from a recording to a result."""

from .motion_from_markers import MarkerMotion, MarkerMotionSettings, motion_from_markers

__all__ = ["MarkerMotion", "MarkerMotionSettings", "motion_from_markers"]
