"""Depth images of a skinned body of known size: joints that are tracked."""

from collections.abc import Callable
from typing import Any

import numpy as np

from solvers.depth_scene import Camera, DepthRecording
from solvers.depth_tracking import capture

from ...depth.depth_sequences import sequence
from ..takes import missed_or_false, point_error

TAKE, FRAMES = "walk_side", range(20, 40, 4)
"""Eight frames a second, of every second row and column."""
FRAME_RATE_HZ = 7.5
ACCURATE_M = 0.1
"""Joints within it count as found, as in the benchmark of depth tracking."""


def prepare() -> dict[str, Any]:
    """Choose frames of a take, and a body of default proportions of the right height."""
    one = sequence(TAKE)
    images = np.stack([one.depth.frame(frame)[::2, ::2] for frame in FRAMES])
    truth = one.joints[list(FRAMES)]
    return {
        "camera": one.depth.camera.every(2),
        "images": images,
        "body": one.typical_body,
        "truth": truth,
    }


def measure(camera: Camera, images: Any, body: Any, truth: Any) -> dict[str, float]:
    """Error of the joints, and flags of low confidence that are wrong."""
    read: Callable[[int], Any] = images.__getitem__
    found = capture(DepthRecording(camera, len(images), FRAME_RATE_HZ, read), body)
    positions = found.joints.positions
    wrong = np.linalg.norm(positions - truth, axis=-1) > ACCURATE_M
    change = np.linalg.norm(np.diff(positions, n=2, axis=0), axis=-1)
    return {
        "error mm": point_error(positions, truth),
        "joints off %": 1.0 + float(100.0 * wrong.mean()),
        "flags missed or false %": 1.0 + missed_or_false(found.low_confidence, wrong),
        "second difference mm": float(1000.0 * change.mean()),
    }
