"""Clean poses from the joints that a depth camera's tracker got wrong or lost."""

from .joint_rotations import Reconstruction
from .pose_completion import PostureMethod, PostureSettings, reconstruct_postures
from .pose_library import (
    PostureLibrary,
    PostureLibrarySettings,
    build_posture_library,
    load_posture_library,
)
from .reconstruct import ReconstructMethod, ReconstructSettings, reconstruct
from .reliability import (
    Reliability,
    ReliabilityMethod,
    ReliabilitySettings,
    measure_reliability,
)
from .residual_correction import (
    CorrectionMethod,
    CorrectionSettings,
    ResidualMethod,
    ResidualPrior,
    ResidualPriorSettings,
    correct_postures,
    learn_residual_prior,
    load_residual_prior,
)

__all__ = [
    "CorrectionMethod",
    "CorrectionSettings",
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
    "build_posture_library",
    "correct_postures",
    "learn_residual_prior",
    "load_posture_library",
    "load_residual_prior",
    "measure_reliability",
    "reconstruct",
    "reconstruct_postures",
]
