"""Optical markers."""

from .solve_skeleton import SolvedSkeleton, SolveSettings, solve_skeleton

__all__ = ["SolveSettings", "SolvedSkeleton", "solve_skeleton"]
