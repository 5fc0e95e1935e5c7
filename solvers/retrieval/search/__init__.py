"""The query and the order of a library's clips for it."""

from .align_clip import aligned
from .describe_query import DescribedQuery, describe_query
from .find_settings import USUAL, FindMethod, FindSettings
from .rank_clips import Ranking, rank_clips

__all__ = [
    "USUAL",
    "DescribedQuery",
    "FindMethod",
    "FindSettings",
    "Ranking",
    "aligned",
    "describe_query",
    "rank_clips",
]
