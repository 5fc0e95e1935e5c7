"""How far each measured joint can be trusted, frame by frame."""

from .left_right_swaps import undo_exchanges
from .scores import Reliability, measure_reliability, posture_reliability
from .settings import ReliabilityMethod, ReliabilitySettings

__all__ = [
    "Reliability",
    "ReliabilityMethod",
    "ReliabilitySettings",
    "measure_reliability",
    "posture_reliability",
    "undo_exchanges",
]
