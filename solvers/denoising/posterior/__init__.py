"""The default method: the posterior of all windows under a prior that adapts to the take."""

from .channel_groups import estimate_in_groups
from .estimate import Estimate

__all__ = [
    "Estimate",
    "estimate_in_groups",
]
