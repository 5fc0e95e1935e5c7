"""What is wrong with a take: jitter, spikes, gaps, sliding feet, stretching bones."""

from .measure import Quality, QualitySettings, measure_quality
from .report import compare_quality
from .worst_issues import Issue, IssueSettings, find_worst_issues

__all__ = [
    "Issue",
    "IssueSettings",
    "Quality",
    "QualitySettings",
    "compare_quality",
    "find_worst_issues",
    "measure_quality",
]
