"""Ray casting of the body model: capsule and depth of each pixel."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Integers
from ...depth_scene import Camera
from .model import BodyModel
from .tables import CAPSULE_SEGMENTS

NO_SEGMENT = -1
MIN_DEPTH_M = 0.05
"""Nearer surfaces are not rendered. It guards a division."""
_EPSILON = 1e-12
"""Square meters below which two directions are parallel. It guards a division."""


@dataclass(frozen=True, eq=False)
class BodyImage:
    """The pixels of a body, in the order of its capsules.

    Attributes
    ----------
    camera : Camera
    pixels : int, shape (n,)
        row * width + column; each once.
    depths : shape (n,), meters
        Along the optical axis.
    capsules : int, shape (n,)
        Index of the visible capsule.
    """

    camera: Camera
    pixels: Integers
    depths: Array
    capsules: Integers

    @property
    def segments(self) -> Integers:
        """Index of the visible segment of each pixel, shape (n,)."""
        return CAPSULE_SEGMENTS[self.capsules]

    def in_front_of(self, occluders: NDArray[np.floating[Any]]) -> "BodyImage":
        """Return the pixels that no occluder hides; their depths (height, width), 0: none."""
        nearer = occluders.ravel()[self.pixels]
        seen = (nearer == 0.0) | (self.depths <= nearer)
        return BodyImage(self.camera, self.pixels[seen], self.depths[seen], self.capsules[seen])

    def depth_image(self) -> Array:
        """Return the depth image (height, width), meters; 0 off the body."""
        image = np.zeros(self.camera.width * self.camera.height)
        image[self.pixels] = self.depths
        return image.reshape(self.camera.height, self.camera.width)


def cast_rays(body: BodyModel, frames: Array, camera: Camera) -> BodyImage:
    """Render a body exactly, without triangles.

    A quadratic equation intersects each capsule with the pixel rays inside its bounding box.
    All boxes are solved together as one list. Elliptic capsules are round in a scaled frame;
    scaling preserves linear relations.

    Parameters
    ----------
    body : BodyModel
    frames : shape (17, 4, 4)
        camera_from_segment of each segment.
    camera : Camera

    Returns
    -------
    BodyImage
    """
    scaled = _scale_capsules(body, frames)
    capsules, columns, rows = _boxes(body, frames, camera)
    x = (columns - camera.cx) / camera.fx
    y = (rows - camera.cy) / camera.fy
    rays = np.stack([x * x, x * y, y * y, x, y, np.ones_like(x)], axis=1)
    hit, depths = _intersect(scaled, capsules, rays)
    return _front(camera, (rows * camera.width + columns)[hit], depths, capsules[hit])


@dataclass(frozen=True, eq=False)
class _ScaledCapsules:
    """Coefficients of the quadratic equations of capsules, in their scaled frames.

    With d the ray and o the camera, seen from an end of the axis: 6 coefficients give d.d from
    x^2, xy, y^2, x, y, 1, and 3 give a product with d from x, y, 1.
    """

    square: Array
    """d.d, shape (n, 6)."""
    along: Array
    """d.axis, shape (n, 3)."""
    from_start: Array
    """d.o seen from the start, shape (n, 3)."""
    from_stop: Array
    numbers: Array
    """axis.axis, axis.o, o.o - 1 from the start, o.o - 1 from the stop, shape (n, 4)."""


def _scale_capsules(body: BodyModel, frames: Array) -> _ScaledCapsules:
    frame = frames[CAPSULE_SEGMENTS]
    scales = 1.0 / body.radii[:, [0, 1, 1]]
    to_stretched = scales[:, :, np.newaxis] * frame[:, :3, :3].swapaxes(1, 2)
    starts, stops = (body.capsule_ends * scales[:, np.newaxis]).swapaxes(0, 1)
    camera = -np.einsum("nij,nj->ni", to_stretched, frame[:, :3, 3])
    axis, from_start, from_stop = stops - starts, camera - starts, camera - stops
    square = to_stretched.swapaxes(1, 2) @ to_stretched
    with_ray = np.stack([axis, from_start, from_stop], axis=1) @ to_stretched
    products = np.einsum("kni,kni->kn", *_pairs(axis, from_start, from_stop))
    return _ScaledCapsules(
        np.stack(
            [square[:, 0, 0], 2 * square[:, 0, 1], square[:, 1, 1],
             2 * square[:, 0, 2], 2 * square[:, 1, 2], square[:, 2, 2]], axis=1,
        ),
        with_ray[:, 0], with_ray[:, 1], with_ray[:, 2],
        (products - [[0.0], [0.0], [1.0], [1.0]]).T,
    )  # fmt: skip


def _pairs(axis: Array, from_start: Array, from_stop: Array) -> tuple[Array, Array]:
    return (
        np.stack([axis, axis, from_start, from_stop]),
        np.stack([axis, from_start, from_start, from_stop]),
    )


def _intersect(
    scaled: _ScaledCapsules, capsules: Integers, rays: Array
) -> tuple[NDArray[np.bool_], Array]:
    """Return the mask of rays that hit their capsule, and the depths of these hits."""
    linear = rays[:, 3:]
    square = np.einsum("nk,nk->n", scaled.square[capsules], rays)
    along = np.einsum("nk,nk->n", scaled.along[capsules], linear)
    toward = np.einsum("nk,nk->n", scaled.from_start[capsules], linear)
    axis, axis_camera, start, stop = scaled.numbers[capsules].T
    a = axis * square - along * along
    b = axis * toward - axis_camera * along
    c = axis * start - axis_camera * axis_camera
    inside = b * b - a * c
    hit = inside >= 0.0
    a, b, square, along = a[hit], b[hit], square[hit], along[hit]
    axis, axis_camera, start, stop = axis[hit], axis_camera[hit], start[hit], stop[hit]
    depths = -(b + np.sqrt(inside[hit])) / np.maximum(a, _EPSILON)
    axis_position = axis_camera + depths * along
    before, behind = axis_position < 0.0, axis_position > axis
    round_end = before | behind
    of_stop = np.einsum("nk,nk->n", scaled.from_stop[capsules[hit]], linear[hit])
    b = np.where(before, toward[hit], of_stop)
    c = np.where(before, start, stop)
    inside = b * b - square * c
    ends = -(b + np.sqrt(np.maximum(inside, 0.0))) / square
    depths = np.where(round_end, ends, depths)
    valid = (~round_end | (inside >= 0.0)) & (depths > MIN_DEPTH_M)
    hit[hit] = valid
    return hit, depths[valid]


def _boxes(
    body: BodyModel, frames: Array, camera: Camera
) -> tuple[Integers, Integers, Integers]:
    """List every pixel of every capsule's bounding box: capsule, column and row of each."""
    frame = frames[CAPSULE_SEGMENTS]
    ends = np.einsum("nij,nej->nei", frame[:, :3, :3], body.capsule_ends)
    ends += frame[:, np.newaxis, :3, 3]
    radii = body.radii.max(axis=1)[:, np.newaxis]
    before = (ends[..., 2] > radii + MIN_DEPTH_M).all(axis=1)
    columns = _span(ends[..., 0], ends[..., 2], radii, camera.fx, camera.cx, camera.width)
    rows = _span(ends[..., 1], ends[..., 2], radii, camera.fy, camera.cy, camera.height)
    widths, heights = (np.maximum(span[1] - span[0] + 1, 0) for span in (columns, rows))
    counts = np.where(before, widths * heights, 0)
    capsules = np.repeat(np.arange(len(counts)), counts)
    within = np.arange(len(capsules)) - np.repeat(np.cumsum(counts) - counts, counts)
    down = within // np.maximum(widths, 1)[capsules]
    across = within - down * widths[capsules]
    return capsules, columns[0][capsules] + across, rows[0][capsules] + down


def _span(
    sideways: Array, forward: Array, radii: Array, focal: float, center: float, size: int
) -> tuple[Integers, Integers]:
    """Return the first and last pixel between the tangents to the balls at both ends."""
    safe = np.maximum(forward, radii + MIN_DEPTH_M)
    root = radii * np.sqrt(sideways**2 + safe**2 - radii**2)
    low = (sideways * safe - root) / (safe**2 - radii**2)
    high = (sideways * safe + root) / (safe**2 - radii**2)
    first = np.ceil(focal * low.min(axis=1) + center)
    last = np.floor(focal * high.max(axis=1) + center)
    return (
        np.clip(first, 0, size).astype(np.intp),
        np.clip(last, -1, size - 1).astype(np.intp),
    )


def _front(camera: Camera, pixels: Integers, depths: Array, capsules: Integers) -> BodyImage:
    """Keep the nearest hit of each pixel; of equal depths the first capsule."""
    nearest = np.full(camera.width * camera.height, np.inf)
    np.minimum.at(nearest, pixels, depths)
    front = depths == nearest[pixels]
    pixels, depths, capsules = pixels[front], depths[front], capsules[front]
    first = np.full(len(nearest), NO_SEGMENT)
    first[pixels[::-1]] = np.arange(len(pixels))[::-1]
    once = first[pixels] == np.arange(len(pixels))
    return BodyImage(camera, pixels[once], depths[once], capsules[once])
