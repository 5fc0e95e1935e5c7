"""Clean recordings: learn how bodies move, and take out jitter, spikes and gaps."""

from .denoise import Denoised, DenoiseSettings, Method, denoise
from .filter_bases import (
    FilterBases,
    FilterBasesSettings,
    learn_filter_bases,
    load_filter_bases,
)

__all__ = [
    "DenoiseSettings",
    "Denoised",
    "FilterBases",
    "FilterBasesSettings",
    "Method",
    "denoise",
    "learn_filter_bases",
    "load_filter_bases",
]
