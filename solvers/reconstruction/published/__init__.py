"""The pose synthesis of the papers as published: frame by frame."""

from .posture_search import search_sequentially

__all__ = [
    "search_sequentially",
]
