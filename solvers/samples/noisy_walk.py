"""The built-in sample take: a walk with the faults that captured motion has."""

from ..motion import Motion
from .corruption import CorruptionSettings, corrupt
from .gait import GaitSettings, walking_gait

GAIT = GaitSettings(duration=8.0, frame_rate=30.0)
FAULTS = CorruptionSettings(jitter=3.0, spikes=0.004, root_jitter=0.004, root_sway=0.03)
MISSING = {"RightArm": range(120, 180)}
"""Two seconds without the right arm, from the middle of the take."""


def noisy_walk() -> Motion:
    """Return a walk of 8 seconds with jitter, spikes, sliding feet and a missing arm."""
    return corrupt(walking_gait(GAIT), FAULTS, missing=MISSING)
