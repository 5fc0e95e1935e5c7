"""Spatial temporal pyramid matching as published [ZH14]."""

from .rank_pyramids import rank_pyramids

__all__ = [
    "rank_pyramids",
]
