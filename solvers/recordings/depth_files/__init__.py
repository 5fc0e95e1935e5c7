"""Read depth images from folders, Matroska, MATLAB, NumPy and raw files."""

from .camera_orientation import rotate_upright
from .depth_formats import detect_depth_format, read_depth
from .exr_header import check_exr
from .folder import check_depth_header, detect_layout, is_depth_folder, resolve_camera
from .image_frames import sort_naturally
from .images import read_pixels
from .layouts import Layout
from .mat import is_depth_mat
from .mkv import NANOSECOND, PIXEL_BYTES, DepthBlocks, depth_track, is_video, read_depth_mkv
from .settings import DEFAULT_DEPTH_SETTINGS, CameraOrientation, DepthSettings

__all__ = [
    "DEFAULT_DEPTH_SETTINGS",
    "NANOSECOND",
    "PIXEL_BYTES",
    "CameraOrientation",
    "DepthBlocks",
    "DepthSettings",
    "Layout",
    "check_depth_header",
    "check_exr",
    "depth_track",
    "detect_depth_format",
    "detect_layout",
    "is_depth_folder",
    "is_depth_mat",
    "is_video",
    "read_depth",
    "read_depth_mkv",
    "read_pixels",
    "resolve_camera",
    "rotate_upright",
    "sort_naturally",
]
