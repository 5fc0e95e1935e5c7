"""Gaussian processes that predict a sensor's errors, and the correction of its poses."""

from .confidence import mean_log_variance
from .correct_postures import (
    CorrectedPostures,
    CorrectionMethod,
    CorrectionSettings,
    TakeOffsets,
    assemble_correction,
    correct_postures,
    mean_offset,
    predict_postures,
    shift_in_world,
    subtract_offsets,
)
from .inputs import SmoothedPostures, smooth_postures
from .kernel import squared_distances
from .learn_confidence import calibrate_confidence
from .learn_residual_prior import ResidualMethod, ResidualPriorSettings, learn_residual_prior
from .residual_prior import ResidualPrior, load_residual_prior
from .smooth_trajectories import TrajectoryFilter

__all__ = [
    "CorrectedPostures",
    "CorrectionMethod",
    "CorrectionSettings",
    "ResidualMethod",
    "ResidualPrior",
    "ResidualPriorSettings",
    "SmoothedPostures",
    "TakeOffsets",
    "TrajectoryFilter",
    "assemble_correction",
    "calibrate_confidence",
    "correct_postures",
    "learn_residual_prior",
    "load_residual_prior",
    "mean_log_variance",
    "mean_offset",
    "predict_postures",
    "shift_in_world",
    "smooth_postures",
    "squared_distances",
    "subtract_offsets",
]
