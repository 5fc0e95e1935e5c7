"""Measure the quality of a take: jitter, spikes, gaps, foot slide, bone-length drift."""

from .issue import Issue
from .measure import Quality, QualitySettings, measure_at_contacts, measure_quality
from .report import compare_quality
from .worst_issues import IssueSettings, find_worst_issues

__all__ = [
    "Issue",
    "IssueSettings",
    "Quality",
    "QualitySettings",
    "compare_quality",
    "find_worst_issues",
    "measure_at_contacts",
    "measure_quality",
]
