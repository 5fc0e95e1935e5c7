"""Clean poses from poor recordings: what a depth camera's tracker got wrong, and physics.

>>> from solvers.reconstruction import simulate
>>> from solvers.samples import GaitSettings, walking_gait
>>> walk = walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))
>>> simulate(walk).message
'The simulated body followed the whole take.'
"""

from .correct_postures import CorrectionMethod, CorrectionSettings, correct_postures
from .learn_residual_prior import (
    ResidualMethod,
    ResidualPriorSettings,
    learn_residual_prior,
)
from .physics_engine import NoPhysicsError
from .physics_settings import Ground, SimulateSettings
from .posture_library import (
    PostureLibrary,
    PostureLibrarySettings,
    build_posture_library,
    load_posture_library,
)
from .posture_settings import PostureMethod, PostureSettings
from .reconstruct import ReconstructMethod, ReconstructSettings, reconstruct
from .reconstruct_postures import reconstruct_postures
from .reliability import Reliability, measure_reliability
from .reliability_markers import measure_marker_reliability
from .reliability_settings import ReliabilityMethod, ReliabilitySettings
from .residual_prior import ResidualPrior, load_residual_prior
from .result import Reconstruction
from .simulate import Simulated, simulate, with_strength

__all__ = [
    "CorrectionMethod",
    "CorrectionSettings",
    "Ground",
    "NoPhysicsError",
    "PostureLibrary",
    "PostureLibrarySettings",
    "PostureMethod",
    "PostureSettings",
    "ReconstructMethod",
    "ReconstructSettings",
    "Reconstruction",
    "Reliability",
    "ReliabilityMethod",
    "ReliabilitySettings",
    "ResidualMethod",
    "ResidualPrior",
    "ResidualPriorSettings",
    "SimulateSettings",
    "Simulated",
    "build_posture_library",
    "correct_postures",
    "learn_residual_prior",
    "load_posture_library",
    "load_residual_prior",
    "measure_marker_reliability",
    "measure_reliability",
    "reconstruct",
    "reconstruct_postures",
    "simulate",
    "with_strength",
]
