"""The cameras of an Azure Kinect or Femto, as their recordings describe them."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import Camera
from ...errors import InvalidFileError
from ...files import DAMAGE
from ...json_text import parse_json

Array = NDArray[np.float64]

DEPTH, COLOR = "CALIBRATION_CameraLocationD0", "CALIBRATION_CameraLocationPV0"
N_PARAMETERS = 14
"""cx cy fx fy k1 to k6 codx cody p2 p1."""
WITHOUT_FACTOR = "Rational6KT"
"""The model of distortion in which the mixed terms are not doubled."""
MODES = {
    (640, 576): (1024, 192, 180),
    (320, 288): (512, 96, 90),
    (512, 512): (512, 0, 0),
    (1024, 1024): (1024, 0, 0),
}
"""Of each size of a depth picture: width of the sensor in its pixels, and what is cropped."""


@dataclass(frozen=True, eq=False)
class K4aCamera:
    """A camera with the distortion of its lens.

    Attributes
    ----------
    camera : Camera
        Without the distortion.
    radial : float array, shape (6,)
        k1 to k6: the first three of the numerator.
    centre : float array, shape (2,)
        Of distortion, as x / z and y / z.
    tangential : float array, shape (2,)
        p1 and p2.
    doubled : bool
        Whether the mixed terms count twice, as in Brown and Conrady's model.
    largest : float
        Distance from the axis, as |(x, y)| / z, up to which the model holds.
    turn, shift : float arrays, shapes (3, 3) and (3,), metres
        From the frame of the depth camera to this one's.
    """

    camera: Camera
    radial: Array
    centre: Array
    tangential: Array
    doubled: bool
    largest: float
    turn: Array
    shift: Array

    def project(self, points: Array) -> Array:
        """Return columns and rows (..., 2) where points (..., 3) of its frame fall; or NaN.

        This is the model of the Azure Kinect's software [1]_.

        References
        ----------
        .. [1] Azure-Kinect-Sensor-SDK, src/transformation/intrinsic_transformation.c.
        """
        z = np.where(points[..., 2:] > 0.0, points[..., 2:], np.nan)
        seen = points[..., :2] / z - self.centre
        x, y = seen[..., 0], seen[..., 1]
        square = x * x + y * y
        k1, k2, k3, k4, k5, k6 = self.radial
        above = 1.0 + square * (k1 + square * (k2 + square * k3))
        below = 1.0 + square * (k4 + square * (k5 + square * k6))
        p1, p2 = self.tangential
        mixed = (2.0 if self.doubled else 1.0) * 2.0 * x * y
        shifts = np.stack(
            [
                (square + 2.0 * x * x) * p2 + mixed * p1,
                (square + 2.0 * y * y) * p1 + mixed * p2,
            ],
            axis=-1,
        )
        bent = seen * (above / below)[..., np.newaxis] + shifts + self.centre
        bent = np.where((square <= self.largest**2)[..., np.newaxis], bent, np.nan)
        focal = (self.camera.fx, self.camera.fy)
        return np.asarray(bent * focal + (self.camera.cx, self.camera.cy))


def depth_camera(path: Path, calibration: bytes, width: int, height: int) -> K4aCamera:
    """Read the depth camera for pictures of one of its four sizes.

    The parameters count the sensor as 1 wide and 1 high, from its corner.

    Raises
    ------
    InvalidFileError
        The calibration is damaged, or the size is none of an Azure Kinect's.
    """
    if (width, height) not in MODES:
        raise InvalidFileError(
            f"{path} has depth of {width} x {height} pixels, which no Azure Kinect has. Give"
            " the camera's focal lengths fx and fy in pixels."
        )
    sensor, left, top = MODES[width, height]
    return _camera(path, calibration, DEPTH, (sensor, sensor, left, top, width, height))


def color_camera(path: Path, calibration: bytes, width: int, height: int) -> K4aCamera:
    """Read the colour camera: 4:3, of which 16:9 pictures have lost rows above and below.

    Raises InvalidFileError if the calibration is damaged.
    """
    whole = round(width * 3 / 4)
    return _camera(
        path, calibration, COLOR, (width, whole, 0, (whole - height) // 2, width, height)
    )


def _camera(
    path: Path, calibration: bytes, place: str, window: tuple[int, int, int, int, int, int]
) -> K4aCamera:
    across, down, left, top, width, height = window
    try:
        told = _find_camera(calibration, place)
        lens = told["Intrinsics"]
        numbers = np.array(lens["ModelParameters"], dtype=np.float64)
        turn = np.array(told["Rt"]["Rotation"], dtype=np.float64).reshape(3, 3)
        shift = np.array(told["Rt"]["Translation"], dtype=np.float64).reshape(3)
        if not np.isfinite(numbers[:N_PARAMETERS]).all() or len(numbers) < N_PARAMETERS:
            raise ValueError(numbers)
        radius = float(told.get("MetricRadius") or 0.0)
        doubled = WITHOUT_FACTOR not in str(lens["ModelType"])
    except DAMAGE:
        raise InvalidFileError(
            f"{path} has no readable calibration of the camera in it. Give the camera's focal"
            " lengths fx and fy in pixels."
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
        centre=numbers[10:12],
        tangential=numbers[[13, 12]],
        doubled=doubled,
        largest=radius if radius > 0.0 else np.inf,
        turn=turn,
        shift=shift,
    )


def _find_camera(calibration: bytes, place: str) -> dict[str, Any]:
    """Return what the calibration says of the camera at this place."""
    cameras = parse_json(calibration.rstrip(b"\0"))["CalibrationInformation"]["Cameras"]
    found: dict[str, Any] = {camera["Location"]: camera for camera in cameras}[place]
    return found
