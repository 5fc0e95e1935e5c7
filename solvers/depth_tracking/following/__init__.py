"""A body tracked in images as they arrive, with the detector in another process."""

from .assemble_followed import assemble_followed
from .live_tracker import LiveTracker
from .pose_detectors import (
    DelayedDetector,
    Detection,
    DetectionRequest,
    PoseDetector,
    detect_in_image,
)

__all__ = [
    "DelayedDetector",
    "Detection",
    "DetectionRequest",
    "LiveTracker",
    "PoseDetector",
    "assemble_followed",
    "detect_in_image",
]
