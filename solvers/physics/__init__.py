"""A simulated body with mass, muscles and ground contact that performs a captured motion.

>>> from solvers.physics import simulate
>>> from solvers.samples import GaitSettings, walking_gait
>>> walk = walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))
>>> simulate(walk).message
'The simulated body followed the complete take.'
"""

from typing import TYPE_CHECKING

from ..import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .engine import NoPhysicsError
    from .report import describe_first_failure
    from .settings import Ground, SimulateSettings
    from .simulate import Simulated, apply_strength, simulate

__all__ = [
    "Ground",
    "NoPhysicsError",
    "SimulateSettings",
    "Simulated",
    "apply_strength",
    "describe_first_failure",
    "simulate",
]

import_on_demand(__name__)
