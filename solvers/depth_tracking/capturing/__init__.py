"""Track a complete recording: body size, passes with restarts, smoothing, manual fixes."""

from .calibrate_body import CalibrationSettings, calibrate_body
from .capture import DEFAULT_CAPTURE, Capture, CaptureSettings, assemble_capture, capture
from .capture_method import CaptureMethod
from .find_body import find_body
from .passes import TrackingContext, track_with_restarts, unwrap_rotation
from .refine_body import RefineBodySettings, refine_body
from .restart_policies import RecoverySettings, RegularChecks
from .retrack import Retracked, retrack
from .retracked_path import RetrackSettings
from .unfinished_capture import unfinished_capture

__all__ = [
    "DEFAULT_CAPTURE",
    "CalibrationSettings",
    "Capture",
    "CaptureMethod",
    "CaptureSettings",
    "RecoverySettings",
    "RefineBodySettings",
    "RegularChecks",
    "RetrackSettings",
    "Retracked",
    "TrackingContext",
    "assemble_capture",
    "calibrate_body",
    "capture",
    "find_body",
    "refine_body",
    "retrack",
    "track_with_restarts",
    "unfinished_capture",
    "unwrap_rotation",
]
