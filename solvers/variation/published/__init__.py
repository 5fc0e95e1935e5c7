"""Variants drawn frame by frame, as published [ZH14], and with axes that covary.

Both are methods of Vary and baselines of `make bench-variation`; the default draws complete
curves.
"""

from .archive import STEPWISE_MEMBER, pack_stepwise, restore_stepwise
from .draw import draw_stepwise_deviations
from .model import StepwiseModel, learn_stepwise

__all__ = [
    "STEPWISE_MEMBER",
    "StepwiseModel",
    "draw_stepwise_deviations",
    "learn_stepwise",
    "pack_stepwise",
    "restore_stepwise",
]
