"""Depth images: folders, Matroska, MATLAB, NumPy and raw files."""

from .exr_header import check_exr
from .folder import is_depth_folder
from .formats import depth_format_of, read_depth
from .image_frames import sort_naturally
from .settings import DEFAULT_DEPTH_SETTINGS, DepthSettings, Held

__all__ = [
    "DEFAULT_DEPTH_SETTINGS",
    "DepthSettings",
    "Held",
    "check_exr",
    "depth_format_of",
    "is_depth_folder",
    "read_depth",
    "sort_naturally",
]
