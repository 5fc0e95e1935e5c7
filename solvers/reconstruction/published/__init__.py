"""Pose synthesis as published: a stochastic search, frame by frame."""

from .posture_search import search_sequentially

__all__ = [
    "search_sequentially",
]
