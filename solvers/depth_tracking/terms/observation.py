"""What the camera saw of an actor in one frame, at one resolution."""

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

LEAST_AREA = 0.02
"""Square metres: half a forearm. Who shows less is not there."""


@dataclass(frozen=True, eq=False)
class Observation:
    """Depths of an actor; everything else in the picture is 0.

    Attributes
    ----------
    camera : Camera
    depth : shape (height, width), metres
    read_color : callable, or None
        Returns the colors of the pixels, as `color` has them. Only terms that compare colors
        ask for them, so that nobody else waits for them, or fails where they are damaged.
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
        """Which pixels see the actor, shape (n,): row * width + column."""
        return np.flatnonzero(self.flat)

    @cached_property
    def empty(self) -> bool:
        """Whether too little of an actor is seen to tell anything."""
        return not len(self.pixels) or len(self.pixels) * self.pixel_area < LEAST_AREA

    @cached_property
    def points(self) -> Array:
        """Where they see the actor, shape (n, 3), metres."""
        return self.points_at(self.pixels)

    @cached_property
    def index_picture(self) -> Integers:
        """Which of `points` each pixel sees, -1 for none, shape (height * width,)."""
        found = np.full(self.flat.shape, -1)
        found[self.pixels] = np.arange(len(self.pixels))
        return found

    @cached_property
    def pixel_area(self) -> float:
        """How much surface a pixel sees where the actor is, square metres."""
        distance = float(np.median(self.points[:, 2]))
        return distance**2 / (self.camera.fx * self.camera.fy)

    @cached_property
    def tree(self) -> Any:
        """The points, ready to be asked for the nearest."""
        return cKDTree(self.points)

    @cached_property
    def nearest_pixel(self) -> Integers:
        """Which pixel that sees the actor is nearest to each pixel, shape (height * width,)."""
        rows, columns = distance_transform_edt(
            self.depth == 0.0, return_distances=False, return_indices=True
        )
        pixels: Integers = (rows.astype(np.intp) * self.camera.width + columns).ravel()
        return pixels

    @cached_property
    def intensities(self) -> Array:
        """Brightness of all pixels, 0 to 255, shape (height * width,); NaN without colours."""
        if self.color is None:
            return np.full(self.flat.shape, np.nan)
        grey: Array = self.color.mean(axis=2).ravel()
        return grey

    @cached_property
    def edges(self) -> Integers:
        """Pixels of the actor at edges of depth, shape (n,)."""
        return edge_pixels(self.depth, self.nearest_pixel)

    def points_at(self, pixels: Integers) -> Array:
        """Return where these pixels (n,) see the actor, shape (n, 3), metres."""
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
    """Return what a frame shows, thinned out to about this many columns."""

    def read_color() -> Array | None:
        color = depth.color(frame)
        return None if color is None else color.astype(np.float64)

    whole = Observation(depth.camera, depth.frame(frame).astype(np.float64), read_color)
    return whole.every(max(1, round(depth.camera.width / picture_width)))


def rays_through_pixels(camera: Camera, pixels: Integers) -> Array:
    """Return where pixels (n,) look, as far as one metre forward, shape (n, 3)."""
    rows, columns = np.divmod(pixels, camera.width)
    rays = np.ones((len(pixels), 3))
    rays[:, 0] = (columns - camera.cx) / camera.fx
    rays[:, 1] = (rows - camera.cy) / camera.fy
    return rays
