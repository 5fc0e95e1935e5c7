"""What files leave open: axes, units, time stamps, sensors and their joints."""

from .axes import (
    CENTIMETRE,
    FEWEST_JOINTS_OF_A_BODY,
    PLAUSIBLE_REACH,
    check_scale,
    guess_unit,
    longest_way,
    turns_y_up_from_z_up,
    turns_z_up_from_y_up,
    y_up_from_z_up,
    z_up_from_y_up,
)
from .bodies import frames_of, longest_seen
from .body_unit import guessed_unit
from .points import METRES, guess_unit_of_points, point_names, points_z_up, said_unit
from .sensor_axes import from_azure_space, from_kinect_space
from .time_stamps import USUAL_RATE, ConstantRate, even_rate
from .tracked_joints import joint_recording

__all__ = [
    "CENTIMETRE",
    "FEWEST_JOINTS_OF_A_BODY",
    "METRES",
    "PLAUSIBLE_REACH",
    "USUAL_RATE",
    "ConstantRate",
    "check_scale",
    "even_rate",
    "frames_of",
    "from_azure_space",
    "from_kinect_space",
    "guess_unit",
    "guess_unit_of_points",
    "guessed_unit",
    "joint_recording",
    "longest_seen",
    "longest_way",
    "point_names",
    "points_z_up",
    "said_unit",
    "turns_y_up_from_z_up",
    "turns_z_up_from_y_up",
    "y_up_from_z_up",
    "z_up_from_y_up",
]
