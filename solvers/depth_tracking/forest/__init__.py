"""The forest of randomized trees that classifies depth pixels as parts of the body."""

from .depth_differences import PixelViews, pixel_views, with_margin
from .grow_tree import TreeSettings, grow_tree
from .parts import HALVED, MIRRORED, N_PARTS, PARTS, parts_of_joints
from .pixel_forest import PixelForest, PixelParts, classify_pixels, load_pixel_forest

__all__ = [
    "HALVED",
    "MIRRORED",
    "N_PARTS",
    "PARTS",
    "PixelForest",
    "PixelParts",
    "PixelViews",
    "TreeSettings",
    "classify_pixels",
    "grow_tree",
    "load_pixel_forest",
    "parts_of_joints",
    "pixel_views",
    "with_margin",
]
