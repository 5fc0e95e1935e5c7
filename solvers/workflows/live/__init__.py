"""Live streams of joints or bones: gestures and performances, and poses of a skeleton."""

from .live_motion import LiveMotion, LiveTakeSettings
from .live_session import LiveSession, SessionUpdate
from .live_take import LiveTake
from .pose_take import PoseTake

__all__ = [
    "LiveMotion",
    "LiveSession",
    "LiveTake",
    "LiveTakeSettings",
    "PoseTake",
    "SessionUpdate",
]
