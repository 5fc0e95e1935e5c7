"""What is expected of a window of motion: filter bases learned from examples, or smoothness."""

from .filter_bases import (
    FilterBases,
    FilterBasesSettings,
    learn_filter_bases,
    load_filter_bases,
)
from .lag_covariance import LagProducts, strongest
from .window_prior import Smoothness, WavePrior, mixed, smooth_prior

__all__ = [
    "FilterBases",
    "FilterBasesSettings",
    "LagProducts",
    "Smoothness",
    "WavePrior",
    "learn_filter_bases",
    "load_filter_bases",
    "mixed",
    "smooth_prior",
    "strongest",
]
