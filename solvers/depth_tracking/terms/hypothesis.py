"""A rendered pose hypothesis: visible surface points and normals."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Integers
from ...depth_scene import Camera
from ..body import (
    CAPSULE_SEGMENTS,
    BodyImage,
    BodyModel,
    cast_rays,
    segment_frames,
    segment_twists,
)
from .observation import rays_through_pixels


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """A pose under test.

    Attributes
    ----------
    body : BodyModel
    pose : shape (36,)
    frames : shape (17, 4, 4)
        Segment transforms in this pose.
    image : BodyImage
    """

    body: BodyModel
    pose: Array
    frames: Array
    image: BodyImage

    @cached_property
    def segments(self) -> Integers:
        """Segment of each visible point, shape (n,)."""
        return self.image.segments

    @cached_property
    def rays(self) -> Array:
        """Rays of the visible points at a depth of one meter, shape (n, 3)."""
        return rays_through_pixels(self.image.camera, self.image.pixels)

    @cached_property
    def points(self) -> Array:
        """Visible points of the surface, shape (n, 3), meters."""
        return self.rays * self.image.depths[:, np.newaxis]

    @cached_property
    def normals(self) -> Array:
        """Outward unit normals at the visible points, shape (n, 3)."""
        return capsule_normals(self.body, self.frames, self.points, self.image.capsules)

    @cached_property
    def twists(self) -> Array:
        """Twist of each segment per unit of each coordinate, shape (17, 6, 36)."""
        return segment_twists(self.pose, self.frames)

    @cached_property
    def index_image(self) -> Integers:
        """Index of the visible point of each pixel, -1 for none, shape (height * width,)."""
        camera = self.image.camera
        indices = np.full(camera.width * camera.height, -1)
        indices[self.image.pixels] = np.arange(len(self.image.pixels))
        return indices


def render_hypothesis(
    body: BodyModel,
    pose: Array,
    camera: Camera,
    occluders: NDArray[np.floating[Any]] | None = None,
) -> Hypothesis:
    """Render `body` in `pose` (36,) as seen by `camera`.

    Points behind the occluders, a depth image (height, width), are left out: what is hidden is
    no evidence against a pose.
    """
    frames = segment_frames(body, pose)
    image = cast_rays(body, frames, camera)
    if occluders is not None:
        image = image.in_front_of(occluders)
    return Hypothesis(body, pose, frames, image)


def capsule_normals(body: BodyModel, frames: Array, points: Array, capsules: Integers) -> Array:
    """Return outward unit normals (n, 3) at points (n, 3) on these capsules (n,)."""
    scales = 1.0 / body.radii[:, [0, 1, 1]]
    capsule_frames = frames[CAPSULE_SEGMENTS]
    # In frames scaled to radius 1, the normal is perpendicular to the axis.
    stretch = scales[:, :, np.newaxis] * capsule_frames[:, :3, :3].swapaxes(1, 2)
    starts, stops = (body.capsule_ends * scales[:, np.newaxis]).swapaxes(0, 1)
    axes = stops - starts
    starts = starts + np.einsum("cij,cj->ci", stretch, capsule_frames[:, :3, 3])
    slopes = axes / (axes**2).sum(axis=1)[:, np.newaxis]
    stretch, axes = stretch[capsules], axes[capsules]
    outward = np.einsum("nij,nj->ni", stretch, points) - starts[capsules]
    along = np.einsum("ni,ni->n", outward, slopes[capsules])
    outward -= np.clip(along, 0.0, 1.0)[:, np.newaxis] * axes
    normals: Array = np.einsum("nji,nj->ni", stretch, outward)
    normals /= np.sqrt(np.einsum("ni,ni->n", normals, normals) + 1e-24)[:, np.newaxis]
    return normals


def capsule_offsets(
    body: BodyModel, frames: Array, points: Array, capsules: Integers
) -> tuple[Array, Array]:
    """Return the relative radius of points at their capsules, and its gradient.

    Returns
    -------
    (n,) array
        Distance from the axis in units of the radius there: 1 on the surface.
    (n, 3) array
        Gradient of it in the camera's frame, per meter.
    """
    frame = frames[CAPSULE_SEGMENTS[capsules]]
    scales = 1.0 / body.radii[capsules][:, [0, 1, 1]]
    local = np.einsum("nji,nj->ni", frame[:, :3, :3], points - frame[:, :3, 3])
    ends = body.capsule_ends[capsules] * scales[:, np.newaxis]
    axis = ends[:, 1] - ends[:, 0]
    from_start = local * scales - ends[:, 0]
    along = np.einsum("ni,ni->n", from_start, axis) / np.einsum("ni,ni->n", axis, axis)
    outward = from_start - np.clip(along, 0.0, 1.0)[:, np.newaxis] * axis
    size = np.sqrt(np.einsum("ni,ni->n", outward, outward))
    slope = scales * outward / np.maximum(size, 1e-12)[:, np.newaxis]
    return size, np.einsum("nij,nj->ni", frame[:, :3, :3], slope)
