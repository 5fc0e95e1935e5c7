"""Estimate a take window by window: the mean of the posterior under a prior that adapts."""

from .channel_groups import estimate_in_groups, window_length

__all__ = ["estimate_in_groups", "window_length"]
