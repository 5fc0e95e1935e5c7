"""Recognize gesture commands in a stream of poses: held hands, strokes and waves."""

from typing import TYPE_CHECKING

from ..import_on_demand import import_on_demand

if TYPE_CHECKING:
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

import_on_demand(__name__)
