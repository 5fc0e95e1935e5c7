"""What joins families: whole ways from a recording to a result."""

from .motion_from_markers import MarkerMotion, MarkerMotionSettings, motion_from_markers
from .postures_of import postures_of
from .reconstruct_motion import RebuiltMotion, reconstruct_motion
from .reconstruct_recording import ReconstructedMotion, reconstruct_recording
from .try_to_plant import Footing, try_to_plant
from .vary_motions import Variants, vary_motions

__all__ = [
    "Footing",
    "MarkerMotion",
    "MarkerMotionSettings",
    "RebuiltMotion",
    "ReconstructedMotion",
    "Variants",
    "motion_from_markers",
    "postures_of",
    "reconstruct_motion",
    "reconstruct_recording",
    "try_to_plant",
    "vary_motions",
]
