"""The posterior of all windows under a prior that adapts to the take, and single outliers."""

from .channel_groups import estimate_in_groups
from .estimate import Estimate, Smoothed
from .outlier_model import OUTLIER_DENSITY
from .windows import Windows

__all__ = [
    "OUTLIER_DENSITY",
    "Estimate",
    "Smoothed",
    "Windows",
    "estimate_in_groups",
]
