"""Describe a take for the animator: its origin, its figures, and what it lacks."""

from .missing_data import (
    describe_empty_frames,
    describe_missing_points,
    drop_missing_points,
    observed_samples,
)
from .take_figures import UNKNOWN, TakeFigures, figure_texts, measure_take
from .take_origin import MotionFromJoints, Take, TakeOrigin, find_origin

__all__ = [
    "UNKNOWN",
    "MotionFromJoints",
    "Take",
    "TakeFigures",
    "TakeOrigin",
    "describe_empty_frames",
    "describe_missing_points",
    "drop_missing_points",
    "figure_texts",
    "find_origin",
    "measure_take",
    "observed_samples",
]
