"""Gaussian processes that predict a sensor's errors, and the correction of its poses."""

from .correct_postures import CorrectionMethod, CorrectionSettings, correct_postures
from .kernel import squared_distances
from .learn_confidence import calibrate_confidence
from .learn_residual_prior import ResidualMethod, ResidualPriorSettings, learn_residual_prior
from .prior import ResidualPrior, load_residual_prior

__all__ = [
    "CorrectionMethod",
    "CorrectionSettings",
    "ResidualMethod",
    "ResidualPrior",
    "ResidualPriorSettings",
    "calibrate_confidence",
    "correct_postures",
    "learn_residual_prior",
    "load_residual_prior",
    "squared_distances",
]
