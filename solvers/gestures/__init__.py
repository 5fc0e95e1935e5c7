"""Commands by gesture: hands held still, strokes and waves, from a stream of postures."""

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
