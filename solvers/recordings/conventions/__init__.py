"""Convert axes, units, time stamps and joints of files to the project's conventions."""

from .axes import (
    CENTIMETER,
    MIN_BODY_JOINTS,
    PLAUSIBLE_REACH_M,
    check_scale,
    guess_unit,
    longest_bone_path,
    rotations_y_up_from_z_up,
    rotations_z_up_from_y_up,
    y_up_from_z_up,
    z_up_from_y_up,
)
from .bodies import (
    ALL_BODIES,
    Bodies,
    Body,
    bodies_of_frames,
    observed_body,
    recorded_seconds,
    stack_body_frames,
)
from .body_axes import (
    UpAxisName,
    describe_guessed_axis,
    judge_up_axis,
    judge_up_of_joints,
    rotate_to_z_up,
    stand_upright,
)
from .body_unit import describe_guessed_unit, question_of_size, stature
from .camera_bodies import is_mirrored, stand_along, up_along
from .file_axes import (
    conventions_of,
    file_conventions,
    reinterpreted,
    turn_between,
    with_axes,
    with_conventions,
)
from .floor import floor_level, lacks_floor, put_on_floor
from .points import (
    METERS,
    axes_of_points,
    guess_unit_of_points,
    is_upside_down,
    judge_axes_of_points,
    meters_from_unit_name,
    point_names,
    points_z_up,
)
from .sensor_axes import from_azure_space, from_kinect_space
from .subjects import bodies_of_joints, bodies_of_markers
from .time_stamps import (
    DEFAULT_FRAME_RATE,
    ConstantRate,
    common_rate,
    constant_rate_from_times,
)
from .tracked_joints import joint_recording

__all__ = [
    "ALL_BODIES",
    "CENTIMETER",
    "DEFAULT_FRAME_RATE",
    "METERS",
    "MIN_BODY_JOINTS",
    "PLAUSIBLE_REACH_M",
    "Bodies",
    "Body",
    "ConstantRate",
    "UpAxisName",
    "axes_of_points",
    "bodies_of_frames",
    "bodies_of_joints",
    "bodies_of_markers",
    "check_scale",
    "common_rate",
    "constant_rate_from_times",
    "conventions_of",
    "describe_guessed_axis",
    "describe_guessed_unit",
    "file_conventions",
    "floor_level",
    "from_azure_space",
    "from_kinect_space",
    "guess_unit",
    "guess_unit_of_points",
    "is_mirrored",
    "is_upside_down",
    "joint_recording",
    "judge_axes_of_points",
    "judge_up_axis",
    "judge_up_of_joints",
    "lacks_floor",
    "longest_bone_path",
    "meters_from_unit_name",
    "observed_body",
    "point_names",
    "points_z_up",
    "put_on_floor",
    "question_of_size",
    "recorded_seconds",
    "reinterpreted",
    "rotate_to_z_up",
    "rotations_y_up_from_z_up",
    "rotations_z_up_from_y_up",
    "stack_body_frames",
    "stand_along",
    "stand_upright",
    "stature",
    "turn_between",
    "up_along",
    "with_axes",
    "with_conventions",
    "y_up_from_z_up",
    "z_up_from_y_up",
]
