"""A body followed from image to image: registration, quality of fit and failures."""

from .failure_test import FailureTest, has_failed
from .fit_quality import FitQuality, fit_quality, unseen
from .pose_preview import FoundPose, OnPose, shifted, unobserved
from .register_pose import Registered, register_pose
from .track_pose import (
    NextPose,
    TrackedMotion,
    follow,
    next_pose_prior,
    track_pose,
    tracked_motion,
)

__all__ = [
    "FailureTest",
    "FitQuality",
    "FoundPose",
    "NextPose",
    "OnPose",
    "Registered",
    "TrackedMotion",
    "fit_quality",
    "follow",
    "has_failed",
    "next_pose_prior",
    "register_pose",
    "shifted",
    "track_pose",
    "tracked_motion",
    "unobserved",
    "unseen",
]
