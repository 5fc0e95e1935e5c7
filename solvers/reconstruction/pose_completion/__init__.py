"""Missing joints completed from a library of poses, weighted by reliability."""

from .bridge_gaps import blend_gaps
from .complete_postures import (
    MODEL_ERROR_M,
    CompletedPostures,
    FittedLibrary,
    ObservedTake,
    complete_from_fitted,
    confidence_from_deviation,
    synthesize,
)
from .reconstruct_postures import CompletedJoints, complete_joints, reconstruct_postures
from .residual_smoother import ResidualFilter
from .settings import PostureSettings

__all__ = [
    "MODEL_ERROR_M",
    "CompletedJoints",
    "CompletedPostures",
    "FittedLibrary",
    "ObservedTake",
    "PostureSettings",
    "ResidualFilter",
    "blend_gaps",
    "complete_from_fitted",
    "complete_joints",
    "confidence_from_deviation",
    "reconstruct_postures",
    "synthesize",
]
