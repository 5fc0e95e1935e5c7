"""Depth images of a body of known size: its size, and a pose that is corrected by hand.

The frames are those of `depth_tracking`; a corrected take is the drawn body of the tests, whose
forearm points up for some frames.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from solvers.depth_scene import Camera, DepthRecording
from solvers.depth_tracking import calibrate_body, refine_body
from solvers.depth_tracking.body.coordinates import COORDINATES
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.motion import body_motion, motion_frames
from solvers.depth_tracking.body.pose_from_joints import pose_from_joints
from solvers.depth_tracking.body.segment_kinematics import joint_positions, segment_frames
from solvers.depth_tracking.capturing.calibrate_body import CalibrationSettings
from solvers.depth_tracking.capturing.find_body import find_body
from solvers.depth_tracking.capturing.retrack import RetrackSettings, retrack
from solvers.depth_tracking.forest import load_pixel_forest
from tests.fixtures.drawn_bodies import recorded, waving

from ...depth.depth_sequences import length_error, sequence
from ..takes import point_error
from .depth_tracking import FRAME_RATE_HZ, FRAMES, TAKE

N_WAVING, CORRECTED, WRONG = 9, 4, slice(2, 7)


def prepare() -> dict[str, Any]:
    """Choose frames of a take, the true body, and the joints of its frames."""
    one = sequence(TAKE)
    return {
        "camera": one.depth.camera.every(2),
        "images": np.stack([one.depth.frame(frame)[::2, ::2] for frame in FRAMES]),
        "true_body": one.typical_body,
        "joints": one.joints[list(FRAMES)],
    }


def measure(camera: Camera, images: Any, true_body: Any, joints: Any) -> dict[str, float]:
    """Errors of bone lengths, of poses fitted to joints, and of a corrected take."""
    read: Callable[[int], Any] = images.__getitem__
    depth = DepthRecording(camera, len(images), FRAME_RATE_HZ, read)
    forest = load_pixel_forest()
    found = {
        "one frame: length %": calibrate_body(depth, 0, forest),
        "one frame, cylinders: length %": calibrate_body(
            depth, 0, forest, settings=CalibrationSettings(refine=False)
        ),
        "stature: length %": find_body(depth, forest, refine=False),
    }
    poses = np.stack([pose_from_joints(true_body, each) for each in joints])
    found["true poses: length %"] = refine_body(depth, true_body.scaled(1.05), poses)
    figures = {name: length_error(body, true_body) for name, body in found.items()}
    fitted = joint_positions(true_body, segment_frames(true_body, poses))
    return figures | {"pose of joints mm": point_error(fitted, joints)} | _corrected()


def _corrected() -> dict[str, float]:
    """Track again from a corrected frame of a waving arm."""
    body, truth = default_body(), waving(N_WAVING)
    wrong = truth.copy()
    wrong[WRONG, COORDINATES.index("rightHumerusZ")] += 1.6
    wrong[CORRECTED] = truth[CORRECTED]
    found = retrack(
        recorded(truth), body, body_motion(body, wrong, 30.0), CORRECTED,
        settings=RetrackSettings(reach=0.15),
    )  # fmt: skip
    joints, true_joints = (
        joint_positions(body, frames)
        for frames in (motion_frames(body, found.motion), segment_frames(body, truth))
    )
    return {
        "corrected take mm": point_error(joints, true_joints),
        "frames that changed": float(found.last - found.first + 1),
    }
