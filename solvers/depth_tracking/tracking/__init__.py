"""A body followed from image to image: registration, quality of fit and failures."""

from .failure_test import FailureTest, has_failed
from .fit_quality import MAX_DEPTH_ERROR_M, FitQuality, fit_quality, quality_without_actor
from .pose_preview import PoseCallback, PosePreview, ignore_pose, offset_frames
from .register_pose import Likelihood, Prior, Registered, descend, register_pose
from .track_pose import (
    FrameLikelihood,
    NextPose,
    TrackedMotion,
    all_terms,
    assemble_motion,
    checked_pose,
    next_pose_prior,
    track_frame,
    track_pose,
)

__all__ = [
    "MAX_DEPTH_ERROR_M",
    "FailureTest",
    "FitQuality",
    "FrameLikelihood",
    "Likelihood",
    "NextPose",
    "PoseCallback",
    "PosePreview",
    "Prior",
    "Registered",
    "TrackedMotion",
    "all_terms",
    "assemble_motion",
    "checked_pose",
    "descend",
    "fit_quality",
    "has_failed",
    "ignore_pose",
    "next_pose_prior",
    "offset_frames",
    "quality_without_actor",
    "register_pose",
    "track_frame",
    "track_pose",
]
