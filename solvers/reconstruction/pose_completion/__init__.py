"""Missing joints completed from a library of poses, weighted by reliability."""

from .bridge_gaps import blend_gaps
from .complete_postures import (
    MODEL_ERROR_M,
    CompletedPostures,
    ObservedTake,
    confidence_from_deviation,
    synthesize,
)
from .reconstruct_postures import complete_joints, reconstruct_postures
from .settings import PostureSettings

__all__ = [
    "MODEL_ERROR_M",
    "CompletedPostures",
    "ObservedTake",
    "PostureSettings",
    "blend_gaps",
    "complete_joints",
    "confidence_from_deviation",
    "reconstruct_postures",
    "synthesize",
]
