"""Depth recordings that are read while a recorder still writes them."""

from .growing_folder import GrowingFolder
from .growing_source import GrowingDepth, ImagePositions, NewImage
from .image_names import PositionKind
from .open_growing import open_growing

__all__ = [
    "GrowingDepth",
    "GrowingFolder",
    "ImagePositions",
    "NewImage",
    "PositionKind",
    "open_growing",
]
