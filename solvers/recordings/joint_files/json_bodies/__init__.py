"""Read the joints of people from JSON, however frames, people and points are nested."""

from .bodies import (
    BodiesFrame,
    BodyJoints,
    checked_objects,
    json_frames,
    name_of_body,
    number,
    open_frames,
    point,
    stack_body,
)
from .people import is_frames_json, is_no_position, people_of_frame
from .points import position_of
from .pose_estimators import is_frame_json, open_frames_json
from .stamps import (
    MAX_SAMPLING_HZ,
    MIN_SAMPLING_HZ,
    is_number,
    stated_rates,
    time_of_frame,
)

__all__ = [
    "MAX_SAMPLING_HZ",
    "MIN_SAMPLING_HZ",
    "BodiesFrame",
    "BodyJoints",
    "checked_objects",
    "is_frame_json",
    "is_frames_json",
    "is_no_position",
    "is_number",
    "json_frames",
    "name_of_body",
    "number",
    "open_frames",
    "open_frames_json",
    "people_of_frame",
    "point",
    "position_of",
    "stack_body",
    "stated_rates",
    "time_of_frame",
]
