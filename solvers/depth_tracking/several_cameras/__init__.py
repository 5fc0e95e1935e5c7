"""Several depth cameras: calibrated by the actor, and one body in all their images."""

from .align_tracks import AlignmentSettings, CameraAlignment, align_tracks
from .capture_cameras import (
    CapturedByCameras,
    about_camera,
    camera_named,
    capture_cameras,
)
from .different_recordings import check_different

__all__ = [
    "AlignmentSettings",
    "CameraAlignment",
    "CapturedByCameras",
    "about_camera",
    "align_tracks",
    "camera_named",
    "capture_cameras",
    "check_different",
]
