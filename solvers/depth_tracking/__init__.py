"""Motion capture from depth images: body model, tracker, detector and complete capture.

>>> from solvers.depth_tracking import track_pose, default_body
>>> from solvers.depth_scene.camera import Camera
>>> from solvers.depth_scene.recording import DepthRecording
>>> import numpy as np
>>> camera = Camera(142.8, 142.8, 79.5, 59.5, 160, 120)
>>> wall = np.full((120, 160), 3.0, dtype=np.float32)
>>> depth = DepthRecording(camera, 2, 30.0, lambda frame: wall)
>>> initial_pose = 2.8 * np.eye(36)[2]
>>> track_pose(depth, default_body(), initial_pose).joints.n_frames
2
"""

from typing import TYPE_CHECKING

from ..import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .body import (
        BodyModel,
        MotionPrior,
        default_body,
        learn_motion_prior,
        load_body_model,
        load_motion_prior,
    )
    from .capturing import (
        CalibrationSettings,
        Capture,
        CaptureMethod,
        CaptureSettings,
        RefineBodySettings,
        Retracked,
        RetrackSettings,
        calibrate_body,
        capture,
        refine_body,
        retrack,
    )
    from .detection import DetectedPose, DetectorSettings, detect_pose
    from .forest import PixelForest, load_pixel_forest
    from .forest_training import (
        PixelForestSettings,
        SkinnedBody,
        load_skinned_body,
        train_pixel_forest,
    )
    from .published import REGISTRATION_TRACKER, track_pose_by_edges
    from .several_bodies import capture_people
    from .several_cameras import (
        AlignmentSettings,
        CameraAlignment,
        CapturedByCameras,
        align_tracks,
        capture_cameras,
    )
    from .terms import TrackerSettings
    from .tracking import TrackedMotion, track_pose

__all__ = [
    "REGISTRATION_TRACKER",
    "AlignmentSettings",
    "BodyModel",
    "CalibrationSettings",
    "CameraAlignment",
    "Capture",
    "CaptureMethod",
    "CaptureSettings",
    "CapturedByCameras",
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
    "align_tracks",
    "calibrate_body",
    "capture",
    "capture_cameras",
    "capture_people",
    "default_body",
    "detect_pose",
    "learn_motion_prior",
    "load_body_model",
    "load_motion_prior",
    "load_pixel_forest",
    "load_skinned_body",
    "refine_body",
    "retrack",
    "track_pose",
    "track_pose_by_edges",
    "train_pixel_forest",
]

import_on_demand(__name__)
