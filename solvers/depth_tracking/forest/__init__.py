"""The forest of randomized trees that classifies depth pixels as parts of the body."""

from .depth_differences import PixelFeatures, pad_depth_image, pixel_features
from .grow_tree import TreeSettings, grow_tree
from .parts import MIRRORED_PARTS, N_PARTS, PARTS, SPLIT_SEGMENTS, parts_of_joints
from .pixel_forest import PixelForest, PixelParts, classify_pixels, load_pixel_forest

__all__ = [
    "MIRRORED_PARTS",
    "N_PARTS",
    "PARTS",
    "SPLIT_SEGMENTS",
    "PixelFeatures",
    "PixelForest",
    "PixelParts",
    "TreeSettings",
    "classify_pixels",
    "grow_tree",
    "load_pixel_forest",
    "pad_depth_image",
    "parts_of_joints",
    "pixel_features",
]
