"""Filter signals over time: noise, spikes, gaps, smoothing and smooth corrections."""

from .gaussian_smoothing import CausalSmoother, smooth_gaussian, smooth_to_the_ends
from .linear_gaps import fill_gaps, fill_rotation_gaps
from .local_median import local_median
from .noise import (
    DIFFERENCE_EFFICIENCY,
    DIFFERENCE_GAIN,
    DIFFERENCE_ORDER,
    MAD_TO_SIGMA,
    estimate_noise,
    fill_channel_gaps,
    remove_outliers,
    shrink_noise,
)
from .second_differences import lower_block_bands, second_difference_bands
from .smoothstep import smoothstep
from .spikes import find_runs, fit_lowess, merge_runs
from .two_states import TwoStateFilter, two_state_probabilities

__all__ = [
    "DIFFERENCE_EFFICIENCY",
    "DIFFERENCE_GAIN",
    "DIFFERENCE_ORDER",
    "MAD_TO_SIGMA",
    "CausalSmoother",
    "TwoStateFilter",
    "estimate_noise",
    "fill_channel_gaps",
    "fill_gaps",
    "fill_rotation_gaps",
    "find_runs",
    "fit_lowess",
    "local_median",
    "lower_block_bands",
    "merge_runs",
    "remove_outliers",
    "second_difference_bands",
    "shrink_noise",
    "smooth_gaussian",
    "smooth_to_the_ends",
    "smoothstep",
    "two_state_probabilities",
]
