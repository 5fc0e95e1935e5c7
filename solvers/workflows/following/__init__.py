"""A depth recording tracked while it is written."""

from .clock import Clock
from .detector_process import DetectorProcess
from .follow_depth import follow_depth
from .follow_settings import FollowSettings
from .follow_state import FollowState
from .followed_motion import FollowedMotion
from .followed_take import FollowedTake, TakeSettings
from .measure_followed import measure_followed

__all__ = [
    "Clock",
    "DetectorProcess",
    "FollowSettings",
    "FollowState",
    "FollowedMotion",
    "FollowedTake",
    "TakeSettings",
    "follow_depth",
    "measure_followed",
]
