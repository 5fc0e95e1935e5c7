"""Track a complete recording: body size, passes with restarts, smoothing, manual fixes."""

from .calibrate_body import CalibrationSettings, calibrate_body
from .capture import (
    DEFAULT_CAPTURE,
    Capture,
    CaptureSettings,
    assemble_capture,
    best_of_passes,
    capture,
)
from .capture_method import CaptureMethod, check_default_method
from .find_body import find_body
from .passes import (
    Pass,
    PassTracker,
    TrackingContext,
    prior_near,
    track_with_restarts,
    unwrap_rotation,
)
from .refine_body import RefineBodySettings, refine_body
from .restart_policies import RecoverySettings, RegularChecks
from .retrack import Retracked, retrack
from .retracked_path import RetrackSettings
from .smooth_pass import acceleration_weights, smooth_in_windows, smooth_poses
from .smooth_take import smooth_take
from .unfinished_capture import unfinished_capture

__all__ = [
    "DEFAULT_CAPTURE",
    "CalibrationSettings",
    "Capture",
    "CaptureMethod",
    "CaptureSettings",
    "Pass",
    "PassTracker",
    "RecoverySettings",
    "RefineBodySettings",
    "RegularChecks",
    "RetrackSettings",
    "Retracked",
    "TrackingContext",
    "acceleration_weights",
    "assemble_capture",
    "best_of_passes",
    "calibrate_body",
    "capture",
    "check_default_method",
    "find_body",
    "prior_near",
    "refine_body",
    "retrack",
    "smooth_in_windows",
    "smooth_poses",
    "smooth_take",
    "track_with_restarts",
    "unfinished_capture",
    "unwrap_rotation",
]
