"""The observed actor in one frame, at one resolution."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt
from scipy.spatial import cKDTree

from ...depth_scene import Camera, DepthRecording
from .depth_edges import edge_pixels

Array = NDArray[np.float64]
Integers = NDArray[np.intp]

MIN_AREA_M2 = 0.02
"""Minimum visible surface of an actor: half a forearm."""


@dataclass(frozen=True, eq=False)
class Observation:
    """Depth image of an actor; 0 elsewhere.

    Attributes
    ----------
    camera : Camera
    depth : shape (height, width), meters
    read_color : callable, or None
        Returns the colors of the pixels, as in `color`. Only terms that compare colors read
        them, so other terms do not depend on damaged or slow color files.
    """

    camera: Camera
    depth: Array
    read_color: Callable[[], Array | None] | None = None

    @cached_property
    def color(self) -> Array | None:
        """Colors of the pixels, shape (height, width, 3), 0 to 255; None where unknown."""
        return None if self.read_color is None else self.read_color()

    @cached_property
    def flat(self) -> Array:
        """Depths of all pixels, shape (height * width,)."""
        return self.depth.ravel()

    @cached_property
    def pixels(self) -> Integers:
        """Pixels of the actor, shape (n,): row * width + column."""
        return np.flatnonzero(self.flat)

    @cached_property
    def empty(self) -> bool:
        """Whether too little of the actor is visible."""
        return not len(self.pixels) or len(self.pixels) * self.pixel_area < MIN_AREA_M2

    @cached_property
    def points(self) -> Array:
        """Observed points of the actor, shape (n, 3), meters."""
        return self.points_at(self.pixels)

    @cached_property
    def index_image(self) -> Integers:
        """Index in `points` of each pixel, -1 for none, shape (height * width,)."""
        indices = np.full(self.flat.shape, -1)
        indices[self.pixels] = np.arange(len(self.pixels))
        return indices

    @cached_property
    def pixel_area(self) -> float:
        """Surface of a pixel at the actor's distance, square meters."""
        distance = float(np.median(self.points[:, 2]))
        return distance**2 / (self.camera.fx * self.camera.fy)

    @cached_property
    def tree(self) -> Any:
        """Search tree of the points."""
        return cKDTree(self.points)

    @cached_property
    def nearest_pixel(self) -> Integers:
        """Pixel of the actor nearest to each pixel, shape (height * width,)."""
        rows, columns = distance_transform_edt(
            self.depth == 0.0, return_distances=False, return_indices=True
        )
        pixels: Integers = (rows.astype(np.intp) * self.camera.width + columns).ravel()
        return pixels

    @cached_property
    def intensities(self) -> Array:
        """Brightness of all pixels, 0 to 255, shape (height * width,); NaN without color."""
        if self.color is None:
            return np.full(self.flat.shape, np.nan)
        gray: Array = self.color.mean(axis=2).ravel()
        return gray

    @cached_property
    def edges(self) -> Integers:
        """Pixels of the actor at depth edges, shape (n,)."""
        return edge_pixels(self.depth, self.nearest_pixel)

    def points_at(self, pixels: Integers) -> Array:
        """Return the observed points (n, 3), meters, at pixels (n,)."""
        rays = rays_through_pixels(self.camera, pixels)
        return rays * self.flat[pixels][:, np.newaxis]

    def every(self, step: int) -> "Observation":
        """Return every `step`-th column and row."""
        if step == 1:
            return self

        def read_color() -> Array | None:
            return None if self.color is None else self.color[::step, ::step]

        return Observation(self.camera.every(step), self.depth[::step, ::step], read_color)


def observe(depth: DepthRecording, frame: int, picture_width: int) -> Observation:
    """Return the observation of a frame, subsampled to about `picture_width` columns."""

    def read_color() -> Array | None:
        color = depth.color(frame)
        return None if color is None else color.astype(np.float64)

    full = Observation(depth.camera, depth.frame(frame).astype(np.float64), read_color)
    return full.every(max(1, round(depth.camera.width / picture_width)))


def rays_through_pixels(camera: Camera, pixels: Integers) -> Array:
    """Return the rays (n, 3) of pixels (n,) at a depth of one meter."""
    rows, columns = np.divmod(pixels, camera.width)
    rays = np.ones((len(pixels), 3))
    rays[:, 0] = (columns - camera.cx) / camera.fx
    rays[:, 1] = (rows - camera.cy) / camera.fy
    return rays
