"""Track a complete recording: body size, passes with restarts, smoothing, manual fixes."""

from .calibrate_body import CalibrationSettings, calibrate_body
from .capture import Capture, CaptureSettings, capture
from .capture_method import CaptureMethod
from .refine_body import RefineBodySettings, refine_body
from .retrack import Retracked, retrack
from .retracked_path import RetrackSettings
from .unfinished_capture import unfinished_capture

__all__ = [
    "CalibrationSettings",
    "Capture",
    "CaptureMethod",
    "CaptureSettings",
    "RefineBodySettings",
    "RetrackSettings",
    "Retracked",
    "calibrate_body",
    "capture",
    "refine_body",
    "retrack",
    "unfinished_capture",
]
