"""The default method of Clean: errors, patterns and smoothers, weighed by prediction."""

from .estimate_and_stack import estimate_and_stack

__all__ = ["estimate_and_stack"]
