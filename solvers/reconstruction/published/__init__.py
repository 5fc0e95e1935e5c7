"""The pose synthesis of the papers as published: frame by frame."""

from .posture_search import search_in_turn

__all__ = [
    "search_in_turn",
]
