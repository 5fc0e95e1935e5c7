"""The pose synthesis of the papers as published: frame by frame."""

from .posture_search import search_in_turn
from .posture_synthesis import solve_in_turn, solve_postures

__all__ = [
    "search_in_turn",
    "solve_in_turn",
    "solve_postures",
]
