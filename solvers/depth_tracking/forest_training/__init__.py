"""Synthetic depth images of many bodies, and the forest trained on them."""

from .skinned_body import SkinnedBody, load_skinned_body
from .train_forest import PixelForestSettings, train_pixel_forest

__all__ = [
    "PixelForestSettings",
    "SkinnedBody",
    "load_skinned_body",
    "train_pixel_forest",
]
