"""Predict missing markers from the markers around them."""

from .fill_markers import FilledMarkers, fill_markers

__all__ = [
    "FilledMarkers",
    "fill_markers",
]
