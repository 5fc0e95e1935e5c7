"""Synthetic samples for tests and demos: a walk, corruption of it, and gestures.

>>> from solvers.samples import CorruptionSettings, GaitSettings, corrupt, walking_gait
>>> walk = walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))
>>> noisy = corrupt(walk, CorruptionSettings(jitter=3.0), missing={"RightArm": range(20, 40)})
>>> bool(walk.observed.all()), int((~noisy.observed).any(axis=1).sum())
(True, 20)
"""

from typing import TYPE_CHECKING

from ..import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .corruption import CorruptionSettings, corrupt
    from .gait import GaitSettings, walking_gait
    from .noisy_walk import noisy_walk
    from .performance import Performance, PerformanceSettings, perform_gestures
    from .walker import walker_skeleton

__all__ = [
    "CorruptionSettings",
    "GaitSettings",
    "Performance",
    "PerformanceSettings",
    "corrupt",
    "noisy_walk",
    "perform_gestures",
    "walker_skeleton",
    "walking_gait",
]

import_on_demand(__name__)
