"""The observed actor in one frame, at one resolution."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from ...arrays import Array, Integers
from ...depth_scene import Camera, DepthRecording

MIN_AREA_M2 = 0.02
"""Minimum visible surface of an actor: half a forearm. It guards images in which the actor is
out of view (`test_observation_of_a_few_pixels_is_empty`)."""


@dataclass(frozen=True, eq=False)
class Observation:
    """Depth image of an actor; 0 elsewhere.

    Attributes
    ----------
    camera : Camera
    depth : shape (height, width), meters
    occluders : shape (height, width), meters, or None
        Depth of what may hide the actor, such as another person; 0 elsewhere.
    """

    camera: Camera
    depth: Array
    occluders: NDArray[np.floating[Any]] | None = None

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
        return scipy.spatial.cKDTree(self.points)

    @cached_property
    def nearest_pixel(self) -> Integers:
        """Pixel of the actor nearest to each pixel, shape (height * width,)."""
        rows, columns = scipy.ndimage.distance_transform_edt(
            self.depth == 0.0, return_distances=False, return_indices=True
        )
        pixels: Integers = (rows.astype(np.intp) * self.camera.width + columns).ravel()
        return pixels

    def points_at(self, pixels: Integers) -> Array:
        """Return the observed points (n, 3), meters, at pixels (n,)."""
        rays = rays_through_pixels(self.camera, pixels)
        return rays * self.flat[pixels][:, np.newaxis]

    def every(self, step: int) -> "Observation":
        """Return every `step`-th column and row."""
        if step == 1:
            return self
        occluders = None if self.occluders is None else self.occluders[::step, ::step]
        return Observation(self.camera.every(step), self.depth[::step, ::step], occluders)


def observe(depth: DepthRecording, frame: int, image_width: int) -> Observation:
    """Return the observation of a frame, subsampled to about `image_width` columns."""
    image, occluders = depth.frame(frame).astype(np.float64), depth.occluders(frame)
    full = Observation(depth.camera, image, occluders)
    return full.every(subsampling_step(depth.camera, image_width))


def subsampling_step(camera: Camera, image_width: int) -> int:
    """Return the step in columns and rows that leaves about `image_width` columns."""
    return max(1, round(camera.width / image_width))


def rays_through_pixels(camera: Camera, pixels: Integers) -> Array:
    """Return the rays (n, 3) of pixels (n,) at a depth of one meter."""
    rows, columns = np.divmod(pixels, camera.width)
    rays = np.ones((len(pixels), 3))
    rays[:, 0] = (columns - camera.cx) / camera.fx
    rays[:, 1] = (rows - camera.cy) / camera.fy
    return rays
