"""Fit motions to goals, such as soles in place, with the least and smoothest change."""

from .fit_in_windows import fit_in_windows
from .fit_motion import Fit, fit_motion
from .goal import Goal
from .normal_equations import NormalEquations
from .variables import FittedMotion

__all__ = [
    "Fit",
    "FittedMotion",
    "Goal",
    "NormalEquations",
    "fit_in_windows",
    "fit_motion",
]
