"""Average the estimate with two smoothers, joint by joint, by their expected error."""

from .average_estimates import average_estimates, blend
from .remaining_noise import MIN_NOISE, noise_factors
from .smoothing_spline import smooth_by_spline

__all__ = [
    "MIN_NOISE",
    "average_estimates",
    "blend",
    "noise_factors",
    "smooth_by_spline",
]
