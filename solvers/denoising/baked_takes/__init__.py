"""Takes that were recorded at a lower rate and interpolated to that of a scene."""

from .find_baking import Baking, find_baking
from .recorded_samples import describe_baking, recorded_samples, restore_rate

__all__ = ["Baking", "describe_baking", "find_baking", "recorded_samples", "restore_rate"]
