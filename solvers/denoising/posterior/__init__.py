"""The default method: the posterior of all windows under a prior that adapts to the take."""

from .channel_groups import estimate_in_groups
from .estimate import Estimate, Smoothed
from .estimate_channels import OUTLIER_DENSITY
from .windows import Windows

__all__ = [
    "OUTLIER_DENSITY",
    "Estimate",
    "Smoothed",
    "Windows",
    "estimate_in_groups",
]
