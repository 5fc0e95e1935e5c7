"""Variants drawn frame by frame, as published [ZH14], and with axes that covary.

Both are methods of Vary and baselines of `make bench-variation`; the default draws complete
curves. `StepwiseModel` is learned, drawn from, saved and restored by its own methods.
"""

from .model import StepwiseModel

__all__ = ["StepwiseModel"]
