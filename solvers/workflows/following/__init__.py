"""A depth recording tracked while it is written."""

from .clock import Clock
from .detector_process import DetectorProcess
from .follow_depth import FollowedMotion, follow_depth
from .follow_settings import FollowSettings
from .followed_take import FollowedTake, TakeSettings
from .measure_followed import measure_followed

__all__ = [
    "Clock",
    "DetectorProcess",
    "FollowSettings",
    "FollowedMotion",
    "FollowedTake",
    "TakeSettings",
    "follow_depth",
    "measure_followed",
]
