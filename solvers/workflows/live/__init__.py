"""Live streams of joints or bones: gestures and performances, and poses of a skeleton."""

from typing import TYPE_CHECKING

from ...import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .live_motion import LiveMotion, LiveTakeSettings
    from .live_session import LiveSession, SessionUpdate
    from .live_take import LiveTake
    from .pose_take import PoseTake
    from .time_slots import TimeSlots

__all__ = [
    "LiveMotion",
    "LiveSession",
    "LiveTake",
    "LiveTakeSettings",
    "PoseTake",
    "SessionUpdate",
    "TimeSlots",
]

import_on_demand(__name__)
