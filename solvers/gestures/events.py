"""What gestures say."""

from dataclasses import dataclass
from enum import Enum


class Gesture(Enum):
    """What the actor wants."""

    HAND_UP = "hand up"
    PAGE_NEXT = "page next"
    PAGE_BACK = "page back"
    CAPTURE_START = "capture start"
    CAPTURE_END = "capture end"
    CAPTURE_DROPPED = "capture dropped"
    ZOOM = "zoom"
    TURN = "turn"


@dataclass(frozen=True)
class GestureEvent:
    """One gesture."""

    gesture: Gesture
    time: float
    """Seconds, when it was recognised."""
    began: float
    """Seconds, when the movement began; a performance ends before its last clap begins."""
    amount: float = 1.0
    """ZOOM: factor by which the hands moved apart; TURN: radians, counter-clockwise as seen
    from above; nothing for others."""
