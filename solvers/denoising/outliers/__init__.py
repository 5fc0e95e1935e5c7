"""The outlier model of Clean: single samples, and errors that last several frames."""

from .outlier_runs import confirm_outliers, find_bursts
from .predictive_density import PredictiveDensity
from .single_outliers import INITIAL_OUTLIER_RATE, compute_inlier_probability

__all__ = [
    "INITIAL_OUTLIER_RATE",
    "PredictiveDensity",
    "compute_inlier_probability",
    "confirm_outliers",
    "find_bursts",
]
