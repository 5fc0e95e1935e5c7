"""The pose in a single depth image, from its classified pixels."""

from .detect_pose import (
    DetectedPose,
    DetectorSettings,
    detect_pose,
    score_body,
    subsample_image,
)

__all__ = [
    "DetectedPose",
    "DetectorSettings",
    "detect_pose",
    "score_body",
    "subsample_image",
]
