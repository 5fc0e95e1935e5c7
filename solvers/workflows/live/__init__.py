"""Live streams of joints: gestures and performances, and poses of a skeleton."""

from .live_session import LiveSession
from .live_take import LiveMotion, LiveTake, LiveTakeSettings

__all__ = ["LiveMotion", "LiveSession", "LiveTake", "LiveTakeSettings"]
