"""How far each measured joint can be trusted, frame by frame."""

from .left_right_swaps import undo_exchanges
from .markers import measure_marker_reliability
from .scores import Reliability, measure_reliability, posture_reliability
from .settings import ReliabilityMethod, ReliabilitySettings

__all__ = [
    "Reliability",
    "ReliabilityMethod",
    "ReliabilitySettings",
    "measure_marker_reliability",
    "measure_reliability",
    "posture_reliability",
    "undo_exchanges",
]
