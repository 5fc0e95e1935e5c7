"""Recognize the body in points of any program, by names, bones or the number of points."""

from .array_names import POINT_MEMBERS, is_other_array, rank_of_array
from .frame_titles import is_frame_title
from .landmark_recording import as_fractions, recording_from_landmarks
from .mediapipe_landmarks import (
    HIPS,
    LANDMARK_JOINTS,
    N_POINTS,
    is_world,
    landmark_columns,
    with_computed_joints,
)
from .named_points import are_joints, body_of_named_points, missing_limbs, n_known_names
from .point_arrays import (
    body_of_points,
    points_of_array,
    read_body,
    refuse_pictures,
    stand_body,
    without_undetected,
)
from .point_titles import (
    Coordinate,
    coordinate_of_title,
    is_quantity,
    names_of_positions,
    numbered_axes,
    without_letter,
)
from .relative_positions import (
    NAMES_OF_ROOT,
    in_room,
    key_of_root,
    name_of_root,
    transforms_at,
)
from .suffixes import groups_by_suffix
from .time_units import (
    TimeCells,
    TimeName,
    column_of_times,
    completed_times,
    is_increasing,
    over_midnight,
    read_time,
    second_of_times,
    time_name,
)
from .unnamed_joints import has_layout, is_no_body

__all__ = [
    "HIPS",
    "LANDMARK_JOINTS",
    "NAMES_OF_ROOT",
    "N_POINTS",
    "POINT_MEMBERS",
    "Coordinate",
    "TimeCells",
    "TimeName",
    "are_joints",
    "as_fractions",
    "body_of_named_points",
    "body_of_points",
    "column_of_times",
    "completed_times",
    "coordinate_of_title",
    "groups_by_suffix",
    "has_layout",
    "in_room",
    "is_frame_title",
    "is_increasing",
    "is_no_body",
    "is_other_array",
    "is_quantity",
    "is_world",
    "key_of_root",
    "landmark_columns",
    "missing_limbs",
    "n_known_names",
    "name_of_root",
    "names_of_positions",
    "numbered_axes",
    "over_midnight",
    "points_of_array",
    "rank_of_array",
    "read_body",
    "read_time",
    "recording_from_landmarks",
    "refuse_pictures",
    "second_of_times",
    "stand_body",
    "time_name",
    "transforms_at",
    "with_computed_joints",
    "without_letter",
    "without_undetected",
]
