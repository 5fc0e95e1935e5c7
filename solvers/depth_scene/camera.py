"""A pinhole camera: where points of the scene fall on its picture, and the way back."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Camera:
    """A pinhole camera without distortion.

    In its own frame x points to the right, y down and z forward, in metres. Column u and row v
    of the picture see along x / z = (u - cx) / fx and y / z = (v - cy) / fy; the middle of the
    first pixel is (0, 0).

    Attributes
    ----------
    fx, fy : float, pixels
        Focal lengths.
    cx, cy : float, pixels
        Where the optical axis meets the picture.
    width, height : int, pixels
    """

    fx: float
    fy: float
    cx: float
    cy: float
    width: int
    height: int

    def __post_init__(self) -> None:
        focal = (self.fx, self.fy, self.cx, self.cy)
        if not (np.isfinite(focal).all() and min(self.fx, self.fy) > 0.0):
            raise InvalidMotionError(
                f"A camera with focal lengths {self.fx:g} and {self.fy:g} and its centre at"
                f" {self.cx:g}, {self.cy:g} sees nothing; focal lengths are positive."
            )
        if min(self.width, self.height) < 1:
            raise InvalidMotionError(
                f"A picture of {self.width} x {self.height} pixels holds nothing."
            )

    def project(self, points: Array) -> Array:
        """Return columns and rows (..., 2) where these points (..., 3) fall; NaN if behind."""
        x, y, z = np.moveaxis(np.asarray(points, dtype=np.float64), -1, 0)
        z = np.where(z > 0.0, z, np.nan)
        return np.stack([self.fx * x / z + self.cx, self.fy * y / z + self.cy], axis=-1)

    def back_project(self, depth: NDArray[np.floating[Any]]) -> Array:
        """Return the points (height, width, 3), metres, of a depth picture (height, width)."""
        depth = np.asarray(depth, dtype=np.float64)
        return self.rays() * depth[..., np.newaxis]

    def rays(self) -> Array:
        """Return where each pixel sees (height, width, 3), as far as one metre forward."""
        x = (np.arange(self.width) - self.cx) / self.fx
        y = (np.arange(self.height) - self.cy) / self.fy
        rays = np.ones((self.height, self.width, 3))
        rays[..., 0], rays[..., 1] = x, y[:, np.newaxis]
        return rays

    def every(self, step: int) -> "Camera":
        """Return the camera of every `step`-th column and row, from the first on."""
        return Camera(
            self.fx / step,
            self.fy / step,
            self.cx / step,
            self.cy / step,
            -(-self.width // step),
            -(-self.height // step),
        )
