"""Gestures in the joints of a camera: how many are recognized as before."""

from typing import Any

from solvers.gestures import GestureSettings
from solvers.gestures.recognition import recognize_gestures
from solvers.samples import PerformanceSettings, perform_gestures

ACTS = (
    "rest", "hand up", "rest", "wave right", "rest", "wave left", "rest", "clap", "rest",
    "zoom in", "rest", "turn", "rest", "zoom out", "clap", "rest",
)  # fmt: skip


def prepare() -> dict[str, Any]:
    """Perform all gestures once, with noise; what is recognized now is wanted."""
    performance = perform_gestures(ACTS, PerformanceSettings(seed=1, noise=0.005))
    stream = performance.times, performance.positions, performance.confidence
    return {"stream": stream, "wanted": _recognized(stream)}


def measure(stream: tuple[Any, ...], wanted: set[tuple[str, int]]) -> dict[str, float]:
    """Count all gestures, and those that are no longer, or newly, recognized in a second."""
    changed = _recognized(stream) ^ wanted
    return {"gestures, and changed ones": float(len(wanted) + len(changed))}


def _recognized(stream: tuple[Any, ...]) -> set[tuple[str, int]]:
    events = recognize_gestures(*stream, GestureSettings())
    return {(event.gesture.name, round(event.time)) for event in events}
