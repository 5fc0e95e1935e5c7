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
    judge_up_axis,
    put_on_floor,
    rotate_to_z_up,
    stand_upright,
)
from .body_unit import describe_guessed_unit
from .camera_bodies import is_mirrored, stand_along
from .points import (
    METERS,
    guess_unit_of_points,
    is_upside_down,
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
    "bodies_of_frames",
    "bodies_of_joints",
    "bodies_of_markers",
    "check_scale",
    "common_rate",
    "constant_rate_from_times",
    "describe_guessed_unit",
    "from_azure_space",
    "from_kinect_space",
    "guess_unit",
    "guess_unit_of_points",
    "is_mirrored",
    "is_upside_down",
    "joint_recording",
    "judge_up_axis",
    "longest_bone_path",
    "meters_from_unit_name",
    "observed_body",
    "point_names",
    "points_z_up",
    "put_on_floor",
    "recorded_seconds",
    "rotate_to_z_up",
    "rotations_y_up_from_z_up",
    "rotations_z_up_from_y_up",
    "stack_body_frames",
    "stand_along",
    "stand_upright",
    "y_up_from_z_up",
    "z_up_from_y_up",
]
