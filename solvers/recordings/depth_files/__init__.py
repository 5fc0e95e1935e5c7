"""Read depth images from folders, Matroska, MATLAB, NumPy and raw files."""

from .depth_formats import detect_depth_format, read_depth
from .exr_header import check_exr
from .folder import is_depth_folder
from .image_frames import sort_naturally
from .mat import is_depth_mat
from .settings import DEFAULT_DEPTH_SETTINGS, CameraOrientation, DepthSettings

__all__ = [
    "DEFAULT_DEPTH_SETTINGS",
    "CameraOrientation",
    "DepthSettings",
    "check_exr",
    "detect_depth_format",
    "is_depth_folder",
    "is_depth_mat",
    "read_depth",
    "sort_naturally",
]
