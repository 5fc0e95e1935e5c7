"""Missing joints completed from a library of poses, weighted by reliability."""

from .bridge_gaps import blend_short_gaps
from .reconstruct_postures import complete_joints, reconstruct_postures
from .settings import PostureMethod, PostureSettings

__all__ = [
    "PostureMethod",
    "PostureSettings",
    "blend_short_gaps",
    "complete_joints",
    "reconstruct_postures",
]
