"""A pinhole camera: projection of points into the image, and back-projection."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..errors import InvalidMotionError


@dataclass(frozen=True)
class Camera:
    """A pinhole camera without distortion.

    In its own frame x points to the right, y down and z forward, in meters. Column u and row v
    of the image look along x / z = (u - cx) / fx and y / z = (v - cy) / fy; the center of the
    first pixel is (0, 0).

    Attributes
    ----------
    fx, fy : float, pixels
        Focal lengths.
    cx, cy : float, pixels
        Principal point.
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
                f"The focal lengths {self.fx:g} and {self.fy:g} and the principal point"
                f" {self.cx:g}, {self.cy:g} are invalid. Give positive focal lengths."
            )
        if min(self.width, self.height) < 1:
            raise InvalidMotionError(
                f"An image of {self.width} x {self.height} pixels is empty. Give a width and"
                " height of at least 1."
            )

    def project(self, points: Array) -> Array:
        """Return the columns and rows (..., 2) of points (..., 3); NaN behind the camera."""
        x, y, z = np.moveaxis(np.asarray(points, dtype=np.float64), -1, 0)
        z = np.where(z > 0.0, z, np.nan)
        return np.stack([self.fx * x / z + self.cx, self.fy * y / z + self.cy], axis=-1)

    def back_project(self, depth: NDArray[np.floating[Any]]) -> Array:
        """Return the points (height, width, 3), meters, of a depth image (height, width)."""
        depth = np.asarray(depth, dtype=np.float64)
        return self.rays() * depth[..., np.newaxis]

    def rays(self) -> Array:
        """Return the ray of each pixel, shape (height, width, 3), at a depth of one meter."""
        x = (np.arange(self.width) - self.cx) / self.fx
        y = (np.arange(self.height) - self.cy) / self.fy
        rays = np.ones((self.height, self.width, 3))
        rays[..., 0], rays[..., 1] = x, y[:, np.newaxis]
        return rays

    def every(self, step: int) -> "Camera":
        """Return the camera of every `step`-th column and row, starting with the first."""
        return Camera(
            self.fx / step,
            self.fy / step,
            self.cx / step,
            self.cy / step,
            -(-self.width // step),
            -(-self.height // step),
        )
