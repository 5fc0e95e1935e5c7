"""Missing joints completed from a library of poses, weighted by reliability."""

from .bridge_gaps import bridged_losses
from .reconstruct_postures import rebuilt_joints, reconstruct_postures
from .settings import PostureMethod, PostureSettings

__all__ = [
    "PostureMethod",
    "PostureSettings",
    "bridged_losses",
    "rebuilt_joints",
    "reconstruct_postures",
]
