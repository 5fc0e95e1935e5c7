"""Read the calibration of the cameras of an Azure Kinect or Femto."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...arrays import Array
from ...depth_scene import Camera
from ...errors import InvalidFileError
from ...files import DAMAGE
from ...json_text import parse_json

DEPTH, COLOR = "CALIBRATION_CameraLocationD0", "CALIBRATION_CameraLocationPV0"
N_PARAMETERS = 14
"""cx cy fx fy k1 to k6 codx cody p2 p1."""
WITHOUT_FACTOR = "Rational6KT"
"""The distortion model in which the mixed terms are not doubled."""
MODES = {
    (640, 576): (1024, 192, 180),
    (320, 288): (512, 96, 90),
    (512, 512): (512, 0, 0),
    (1024, 1024): (1024, 0, 0),
}
"""Width of the sensor in pixels, and cropped columns and rows, by size of the depth image."""


@dataclass(frozen=True, eq=False)
class K4aCamera:
    """A camera with lens distortion.

    Attributes
    ----------
    camera : Camera
        Without distortion.
    radial : float array, shape (6,)
        k1 to k6; the first three are in the numerator.
    center : float array, shape (2,)
        Center of distortion, as x / z and y / z.
    tangential : float array, shape (2,)
        p1 and p2.
    doubled : bool
        Whether the mixed terms are doubled, as in Brown and Conrady's model.
    max_radius : float
        Maximum distance from the axis, as |(x, y)| / z, for which the model is valid.
    rotation, translation : float arrays, shapes (3, 3) and (3,), meters
        From the depth camera's space to this camera's.
    """

    camera: Camera
    radial: Array
    center: Array
    tangential: Array
    doubled: bool
    max_radius: float
    rotation: Array
    translation: Array

    def project(self, points: Array) -> Array:
        """Project points (..., 3) of camera space to columns and rows (..., 2); NaN if invalid.

        The model is that of the Azure Kinect SDK [1]_.

        References
        ----------
        .. [1] Azure-Kinect-Sensor-SDK, src/transformation/intrinsic_transformation.c.
        """
        z = np.where(points[..., 2:] > 0.0, points[..., 2:], np.nan)
        direction = points[..., :2] / z - self.center
        x, y = direction[..., 0], direction[..., 1]
        squared_radius = x * x + y * y
        k1, k2, k3, k4, k5, k6 = self.radial
        numerator = 1.0 + squared_radius * (k1 + squared_radius * (k2 + squared_radius * k3))
        denominator = 1.0 + squared_radius * (k4 + squared_radius * (k5 + squared_radius * k6))
        p1, p2 = self.tangential
        mixed_term = (2.0 if self.doubled else 1.0) * 2.0 * x * y
        tangential_offset = np.stack(
            [
                (squared_radius + 2.0 * x * x) * p2 + mixed_term * p1,
                (squared_radius + 2.0 * y * y) * p1 + mixed_term * p2,
            ],
            axis=-1,
        )
        distorted = (
            direction * (numerator / denominator)[..., np.newaxis]
            + tangential_offset
            + self.center
        )
        distorted = np.where(
            (squared_radius <= self.max_radius**2)[..., np.newaxis], distorted, np.nan
        )
        focal = (self.camera.fx, self.camera.fy)
        return np.asarray(distorted * focal + (self.camera.cx, self.camera.cy))


def depth_camera(path: Path, calibration: bytes, width: int, height: int) -> K4aCamera:
    """Read the depth camera for images of one of its four sizes.

    The parameters are relative to the width and height of the sensor, from its corner.

    Raises
    ------
    InvalidFileError
        The calibration is damaged, or the size is not one of an Azure Kinect.
    """
    if (width, height) not in MODES:
        raise InvalidFileError(
            f"{path} has depth of {width} x {height} pixels, which no Azure Kinect has. Set"
            " the camera's focal lengths fx and fy in pixels."
        )
    sensor, left, top = MODES[width, height]
    return _camera(path, calibration, DEPTH, (sensor, sensor, left, top, width, height))


def color_camera(path: Path, calibration: bytes, width: int, height: int) -> K4aCamera:
    """Read the color camera: 4:3; images of 16:9 are cropped above and below.

    Raises InvalidFileError if the calibration is damaged.
    """
    full_height = round(width * 3 / 4)
    return _camera(
        path,
        calibration,
        COLOR,
        (width, full_height, 0, (full_height - height) // 2, width, height),
    )


def _camera(
    path: Path, calibration: bytes, location: str, window: tuple[int, int, int, int, int, int]
) -> K4aCamera:
    across, down, left, top, width, height = window
    try:
        description = _find_camera(calibration, location)
        lens = description["Intrinsics"]
        numbers = np.array(lens["ModelParameters"], dtype=np.float64)
        rotation = np.array(description["Rt"]["Rotation"], dtype=np.float64).reshape(3, 3)
        translation = np.array(description["Rt"]["Translation"], dtype=np.float64).reshape(3)
        if not np.isfinite(numbers[:N_PARAMETERS]).all() or len(numbers) < N_PARAMETERS:
            raise ValueError(numbers)
        radius = float(description.get("MetricRadius") or 0.0)
        doubled = WITHOUT_FACTOR not in str(lens["ModelType"])
    except DAMAGE:
        raise InvalidFileError(
            f"{path} has no readable calibration of the camera. Set the camera's focal lengths"
            " fx and fy in pixels."
        ) from None
    cx, cy, fx, fy = numbers[:4]
    if radius <= 0.0 and len(numbers) > N_PARAMETERS:
        radius = float(numbers[N_PARAMETERS])
    camera = Camera(
        float(fx) * across,
        float(fy) * down,
        float(cx) * across - left - 0.5,
        float(cy) * down - top - 0.5,
        width,
        height,
    )
    return K4aCamera(
        camera,
        radial=numbers[4:10],
        center=numbers[10:12],
        tangential=numbers[[13, 12]],
        doubled=doubled,
        max_radius=radius if radius > 0.0 else np.inf,
        rotation=rotation,
        translation=translation,
    )


def _find_camera(calibration: bytes, location: str) -> dict[str, Any]:
    """Return the description of the camera at a location."""
    cameras = parse_json(calibration.rstrip(b"\0"))["CalibrationInformation"]["Cameras"]
    description: dict[str, Any] = {camera["Location"]: camera for camera in cameras}[location]
    return description
