"""Read depth images from folders, Matroska, MATLAB, NumPy and raw files."""

from .camera_orientation import rotate_upright
from .depth_formats import detect_depth_format, read_depth
from .exr_header import check_exr
from .folder import check_depth_header, detect_layout, is_depth_folder, resolve_camera
from .image_frames import sort_naturally
from .images import read_pixels
from .layouts import Layout
from .settings import DEFAULT_DEPTH_SETTINGS, CameraOrientation, DepthSettings

__all__ = [
    "DEFAULT_DEPTH_SETTINGS",
    "CameraOrientation",
    "DepthSettings",
    "Layout",
    "check_depth_header",
    "check_exr",
    "detect_depth_format",
    "detect_layout",
    "is_depth_folder",
    "read_depth",
    "read_pixels",
    "resolve_camera",
    "rotate_upright",
    "sort_naturally",
]
