"""Describe a query and rank the clips of a library."""

from .align_clip import align_frames
from .describe_query import DescribedQuery, describe_query
from .find_settings import DEFAULT_FIND_SETTINGS, FindMethod, FindSettings
from .rank_clips import Ranking, rank_clips

__all__ = [
    "DEFAULT_FIND_SETTINGS",
    "DescribedQuery",
    "FindMethod",
    "FindSettings",
    "Ranking",
    "align_frames",
    "describe_query",
    "rank_clips",
]
