"""The gestures that are recognized, and the event of one."""

from dataclasses import dataclass
from enum import Enum


class Gesture(Enum):
    """Command of the actor."""

    HAND_UP = "hand up"
    HAND_UP_AGAIN = "hand up again"
    LEFT_HAND_UP = "left hand up"
    PAGE_NEXT = "page next"
    PAGE_BACK = "page back"
    CAPTURE_START = "capture start"
    CAPTURE_END = "capture end"
    CAPTURE_DROPPED = "capture dropped"
    ZOOM = "zoom"
    TURN = "turn"


@dataclass(frozen=True)
class GestureEvent:
    """One recognized gesture."""

    gesture: Gesture
    time: float
    """Seconds, at recognition."""
    began: float
    """Seconds, at the start of the movement; a performance ends before its last clap starts."""
    amount: float = 1.0
    """ZOOM: factor of the hands' distance; TURN: radians, counter-clockwise seen from above; 1
    for all others."""
