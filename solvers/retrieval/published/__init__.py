"""Spatial temporal pyramid matching as published [ZH14].

It is a method of `find_similar` and a baseline of `make bench-retrieval`. It stays as the paper
prints it; the default ranks clips by other features.
"""

from .rank_pyramids import rank_pyramids

__all__ = [
    "rank_pyramids",
]
