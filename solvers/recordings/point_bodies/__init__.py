"""Recognize the body in points of any program, by names, bones or the number of points."""

from .landmark_recording import recording_from_landmarks
from .mediapipe_landmarks import (
    HIPS,
    LANDMARK_JOINTS,
    N_POINTS,
    is_world,
    seconds,
    with_computed_joints,
)
from .named_points import body_of_named_points, missing_limbs
from .point_arrays import (
    body_of_points,
    points_of_array,
    read_body,
    stand_body,
    without_undetected,
)
from .time_units import second_of_times
from .unnamed_joints import has_layout

__all__ = [
    "HIPS",
    "LANDMARK_JOINTS",
    "N_POINTS",
    "body_of_named_points",
    "body_of_points",
    "has_layout",
    "is_world",
    "missing_limbs",
    "points_of_array",
    "read_body",
    "recording_from_landmarks",
    "second_of_times",
    "seconds",
    "stand_body",
    "with_computed_joints",
    "without_undetected",
]
