"""Several depth cameras: calibrated by the actor, and one body in all their images."""

from .align_tracks import AlignmentSettings, CameraAlignment, align_tracks
from .capture_cameras import CapturedByCameras, camera_named, capture_cameras

__all__ = [
    "AlignmentSettings",
    "CameraAlignment",
    "CapturedByCameras",
    "align_tracks",
    "camera_named",
    "capture_cameras",
]
