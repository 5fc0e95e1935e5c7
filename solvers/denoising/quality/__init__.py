"""What is wrong with a take: jitter, spikes, gaps, sliding feet, stretching bones."""

from .measure import Quality, QualitySettings, measure_quality
from .report import compare_quality
from .worst_issues import Spot, SpotSettings, find_worst_spots

__all__ = [
    "Quality",
    "QualitySettings",
    "Spot",
    "SpotSettings",
    "compare_quality",
    "find_worst_spots",
    "measure_quality",
]
