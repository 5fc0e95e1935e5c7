"""Describe a query and rank the clips of a library."""

from .align_clip import align_frames
from .describe_query import DescribedQuery, describe_query
from .find_settings import DEFAULT_FIND_SETTINGS, FindMethod, FindSettings
from .rank_clips import (
    Candidates,
    Ranking,
    collect_candidates,
    merge_candidates,
    rank_candidates,
    rank_clips,
)

__all__ = [
    "DEFAULT_FIND_SETTINGS",
    "Candidates",
    "DescribedQuery",
    "FindMethod",
    "FindSettings",
    "Ranking",
    "align_frames",
    "collect_candidates",
    "describe_query",
    "merge_candidates",
    "rank_candidates",
    "rank_clips",
]
