"""Depth images: folders, Matroska, MATLAB, NumPy and raw files."""

from .exr_header import check_exr
from .folder import is_depth_folder
from .formats import depth_format_of, read_depth
from .image_frames import in_order
from .settings import USUAL, DepthSettings, Held

__all__ = [
    "USUAL",
    "DepthSettings",
    "Held",
    "check_exr",
    "depth_format_of",
    "in_order",
    "is_depth_folder",
    "read_depth",
]
