"""From depth pictures to motion: body model, tracker, detector, and both together.

>>> from solvers.depth_tracking import track_pose, usual_body
>>> from solvers.motion.camera import Camera
>>> from solvers.motion.depth_recording import DepthRecording
>>> import numpy as np
>>> camera = Camera(142.8, 142.8, 79.5, 59.5, 160, 120)
>>> wall = np.full((120, 160), 3.0, dtype=np.float32)
>>> depth = DepthRecording(camera, 2, 30.0, lambda frame: wall)
>>> before_the_camera = 2.8 * np.eye(36)[2]
>>> track_pose(depth, usual_body(), before_the_camera).joints.n_frames
2
"""

from .body_model import BodyModel, load_body_model, usual_body
from .calibrate_body import CalibrationSettings, calibrate_body
from .capture import Capture, CaptureSettings, capture
from .detect_pose import DetectedPose, DetectorSettings, detect_pose
from .learn_motion_prior import learn_motion_prior
from .motion_prior import MotionPrior, load_motion_prior
from .pixel_forest import PixelForest, load_pixel_forest
from .refine_body import RefineBodySettings, refine_body
from .retrack import Retracked, retrack
from .retracked_course import RetrackSettings
from .skinned_body import SkinnedBody, load_skinned_body
from .track_pose import TrackedMotion, track_pose
from .tracker_settings import LOU12, WZC12, TrackerSettings
from .train_forest import PixelForestSettings, train_pixel_forest

__all__ = [
    "LOU12",
    "WZC12",
    "BodyModel",
    "CalibrationSettings",
    "Capture",
    "CaptureSettings",
    "DetectedPose",
    "DetectorSettings",
    "MotionPrior",
    "PixelForest",
    "PixelForestSettings",
    "RefineBodySettings",
    "RetrackSettings",
    "Retracked",
    "SkinnedBody",
    "TrackedMotion",
    "TrackerSettings",
    "calibrate_body",
    "capture",
    "detect_pose",
    "learn_motion_prior",
    "load_body_model",
    "load_motion_prior",
    "load_pixel_forest",
    "load_skinned_body",
    "refine_body",
    "retrack",
    "track_pose",
    "train_pixel_forest",
    "usual_body",
]
