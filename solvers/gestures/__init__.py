"""Recognize gesture commands in a stream of poses: held hands, strokes and waves."""

from .events import Gesture, GestureEvent
from .recognition import GestureRecognizer, Mode
from .settings import GestureSettings

__all__ = [
    "Gesture",
    "GestureEvent",
    "GestureRecognizer",
    "GestureSettings",
    "Mode",
]
