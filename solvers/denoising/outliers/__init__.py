"""The outlier model of Clean: single samples, and errors that last several frames."""

from .outlier_runs import confirm_outliers, find_bursts
from .predictive_density import OFFSET_DEVIATION, PredictiveDensity
from .single_outliers import (
    MIN_OUTLIER_RATE,
    compute_inlier_probability,
    fit_inlier_probability,
    outlier_rate,
)

__all__ = [
    "MIN_OUTLIER_RATE",
    "OFFSET_DEVIATION",
    "PredictiveDensity",
    "compute_inlier_probability",
    "confirm_outliers",
    "find_bursts",
    "fit_inlier_probability",
    "outlier_rate",
]
