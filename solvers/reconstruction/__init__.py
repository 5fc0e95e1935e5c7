"""Clean poses from poor recordings: what a depth camera's tracker got wrong, and physics.

>>> from solvers.reconstruction import simulate
>>> from solvers.samples import GaitSettings, walking_gait
>>> walk = walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))
>>> simulate(walk).message
'The simulated body followed the whole take.'
"""

from .physics_engine import NoPhysicsError
from .reliability import Reliability, measure_reliability
from .reliability_markers import measure_marker_reliability
from .reliability_settings import ReliabilityMethod, ReliabilitySettings
from .simulate import Ground, Simulated, SimulateSettings, simulate, with_strength

__all__ = [
    "Ground",
    "NoPhysicsError",
    "Reliability",
    "ReliabilityMethod",
    "ReliabilitySettings",
    "SimulateSettings",
    "Simulated",
    "measure_marker_reliability",
    "measure_reliability",
    "simulate",
    "with_strength",
]
