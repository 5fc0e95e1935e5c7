"""Clean recordings: learn how bodies move, and take out jitter, spikes and gaps."""

from .denoise import Denoised, DenoiseSettings, Method, denoise
from .filter_bases import (
    FilterBases,
    FilterBasesSettings,
    learn_filter_bases,
    load_filter_bases,
)
from .plant_feet import Planted, PlantSettings, plant_feet
from .quality import Quality, QualitySettings, measure_quality
from .quality_report import compare_quality

__all__ = [
    "DenoiseSettings",
    "Denoised",
    "FilterBases",
    "FilterBasesSettings",
    "Method",
    "PlantSettings",
    "Planted",
    "Quality",
    "QualitySettings",
    "compare_quality",
    "denoise",
    "learn_filter_bases",
    "load_filter_bases",
    "measure_quality",
    "plant_feet",
]
