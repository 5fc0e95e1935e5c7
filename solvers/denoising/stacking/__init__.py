"""The default method of Clean: find errors, estimate by patterns, average with smoothers."""

from .estimate_and_stack import estimate_and_stack

__all__ = ["estimate_and_stack"]
