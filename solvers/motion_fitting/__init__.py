"""Fit motions to goals: effectors in place, reach, limits, with the least smooth change."""

from .fit_motion import Fit, fit_motion
from .variables import FittedMotion

__all__ = ["Fit", "FittedMotion", "fit_motion"]
