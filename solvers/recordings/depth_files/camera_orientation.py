"""Rotate depth recordings upright, and undo mirroring."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...depth_scene import Camera, DepthRecording
from .settings import CameraOrientation

QUARTER_TURNS = {
    CameraOrientation.KNOWN: 0,
    CameraOrientation.UPRIGHT: 0,
    CameraOrientation.LEFT: 3,
    CameraOrientation.UPSIDE_DOWN: 2,
    CameraOrientation.RIGHT: 1,
}
"""Counterclockwise quarter turns that rotate images upright."""


@dataclass(frozen=True)
class _RotatedReader:
    """Read images, mirror them and rotate them counterclockwise by quarter turns."""

    read: Any
    quarters: int
    mirrored: bool

    def __call__(self, index: int) -> Any:
        image = self.read(index)
        if self.mirrored:
            image = image[:, ::-1]
        return np.ascontiguousarray(np.rot90(image, self.quarters))


def rotate_upright(
    recording: DepthRecording, held: CameraOrientation, mirrored: bool
) -> DepthRecording:
    """Return the recording of an upright camera without mirroring."""
    quarters = QUARTER_TURNS[held]
    if not (quarters or mirrored):
        return recording
    camera = _mirror_camera(recording.camera) if mirrored else recording.camera
    for _ in range(quarters):
        camera = _rotate_camera(camera)
    color = recording.read_color
    return replace(
        recording,
        camera=camera,
        read_depth=_RotatedReader(recording.read_depth, quarters, mirrored),
        read_color=None if color is None else _RotatedReader(color, quarters, mirrored),
    )


def _mirror_camera(camera: Camera) -> Camera:
    return replace(camera, cx=camera.width - 1 - camera.cx)


def _rotate_camera(camera: Camera) -> Camera:
    """Return the camera of images after a counterclockwise quarter turn: right becomes top."""
    return Camera(
        camera.fy,
        camera.fx,
        camera.cy,
        camera.width - 1 - camera.cx,
        camera.height,
        camera.width,
    )
