"""Windows of a take, and priors over one: filter bases of examples, or smoothness alone."""

from .filter_bases import (
    FilterBases,
    FilterBasesSettings,
    learn_filter_bases,
    load_filter_bases,
)
from .lag_covariance import LagProducts, find_leading_eigenpairs
from .noise_spectrum import WHITE, NoiseSpectrum
from .window_prior import SmoothPrior, WindowPrior, build_smooth_prior, mix_priors
from .windows import N_OVERLAPS, Windows

__all__ = [
    "N_OVERLAPS",
    "WHITE",
    "FilterBases",
    "FilterBasesSettings",
    "LagProducts",
    "NoiseSpectrum",
    "SmoothPrior",
    "WindowPrior",
    "Windows",
    "build_smooth_prior",
    "find_leading_eigenpairs",
    "learn_filter_bases",
    "load_filter_bases",
    "mix_priors",
]
