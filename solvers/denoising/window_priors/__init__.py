"""Priors over a window of motion: filter bases learned from examples, or smoothness alone."""

from .filter_bases import (
    FilterBases,
    FilterBasesSettings,
    learn_filter_bases,
    load_filter_bases,
)
from .lag_covariance import LagProducts, find_leading_eigenpairs
from .window_prior import SmoothPrior, WindowPrior, build_smooth_prior, mix_priors

__all__ = [
    "FilterBases",
    "FilterBasesSettings",
    "LagProducts",
    "SmoothPrior",
    "WindowPrior",
    "build_smooth_prior",
    "find_leading_eigenpairs",
    "learn_filter_bases",
    "load_filter_bases",
    "mix_priors",
]
