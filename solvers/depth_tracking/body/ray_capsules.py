"""Pictures of a body: which of its capsules each pixel sees, and how far away."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import Camera
from .model import BodyModel
from .tables import CAPSULE_SEGMENTS

Array = NDArray[np.float64]
Integers = NDArray[np.intp]

NOTHING = -1
_NEAREST = 0.05
"""Metres before the camera; what comes nearer is not drawn."""
_ALMOST_NOTHING = 1e-12


@dataclass(frozen=True, eq=False)
class BodyImage:
    """The pixels that see a body, in the order of its capsules.

    Attributes
    ----------
    camera : Camera
    pixels : int, shape (n,)
        row * width + column; each once.
    depths : shape (n,), metres
        Along the optical axis.
    capsules : int, shape (n,)
        Index of the capsule seen.
    """

    camera: Camera
    pixels: Integers
    depths: Array
    capsules: Integers

    @property
    def segments(self) -> Integers:
        """Index of the segment that each pixel sees, shape (n,)."""
        return CAPSULE_SEGMENTS[self.capsules]

    def depth_picture(self) -> Array:
        """Return the depths as a picture (height, width), metres; 0 where nothing is seen."""
        return self._picture(self.depths, 0.0)

    def segment_picture(self) -> Array:
        """Return the segments as a picture (height, width), -1 where nothing is seen."""
        return self._picture(self.segments, NOTHING)

    def _picture(self, values: NDArray[np.generic], nothing: float) -> Array:
        picture = np.full(self.camera.width * self.camera.height, nothing)
        picture[self.pixels] = values
        return picture.reshape(self.camera.height, self.camera.width)


def cast_rays(body: BodyModel, frames: Array, camera: Camera) -> BodyImage:
    """Draw a body exactly, without triangles.

    The ray of each pixel inside a capsule's bounding box on the picture meets the capsule
    where a quadratic equation says; all boxes are solved together as one list. Elliptic
    capsules are round ones in a frame that is stretched, which keeps what is linear linear.

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
    stretched = _stretched(body, frames)
    capsules, columns, rows = _boxes(body, frames, camera)
    x = (columns - camera.cx) / camera.fx
    y = (rows - camera.cy) / camera.fy
    rays = np.stack([x * x, x * y, y * y, x, y, np.ones_like(x)], axis=1)
    hit, depths = _meet(stretched, capsules, rays)
    return _front(camera, (rows * camera.width + columns)[hit], depths, capsules[hit])


@dataclass(frozen=True, eq=False)
class _Stretched:
    """What the quadratic equations of capsules consist of, in their stretched frames.

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


def _stretched(body: BodyModel, frames: Array) -> _Stretched:
    frame = frames[CAPSULE_SEGMENTS]
    scales = 1.0 / body.radii[:, [0, 1, 1]]
    to_stretched = scales[:, :, np.newaxis] * frame[:, :3, :3].swapaxes(1, 2)
    starts, stops = (body.capsule_ends * scales[:, np.newaxis]).swapaxes(0, 1)
    camera = -np.einsum("nij,nj->ni", to_stretched, frame[:, :3, 3])
    axis, from_start, from_stop = stops - starts, camera - starts, camera - stops
    square = to_stretched.swapaxes(1, 2) @ to_stretched
    with_ray = np.stack([axis, from_start, from_stop], axis=1) @ to_stretched
    products = np.einsum("kni,kni->kn", *_pairs(axis, from_start, from_stop))
    return _Stretched(
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


def _meet(
    stretched: _Stretched, capsules: Integers, rays: Array
) -> tuple[NDArray[np.bool_], Array]:
    """Return which rays meet their capsule, and the depths where those do."""
    linear = rays[:, 3:]
    square = np.einsum("nk,nk->n", stretched.square[capsules], rays)
    along = np.einsum("nk,nk->n", stretched.along[capsules], linear)
    toward = np.einsum("nk,nk->n", stretched.from_start[capsules], linear)
    axis, axis_camera, start, stop = stretched.numbers[capsules].T
    a = axis * square - along * along
    b = axis * toward - axis_camera * along
    c = axis * start - axis_camera * axis_camera
    inside = b * b - a * c
    hit = inside >= 0.0
    a, b, square, along = a[hit], b[hit], square[hit], along[hit]
    axis, axis_camera, start, stop = axis[hit], axis_camera[hit], start[hit], stop[hit]
    depths = -(b + np.sqrt(inside[hit])) / np.maximum(a, _ALMOST_NOTHING)
    place = axis_camera + depths * along
    before, behind = place < 0.0, place > axis
    round_end = before | behind
    of_stop = np.einsum("nk,nk->n", stretched.from_stop[capsules[hit]], linear[hit])
    b = np.where(before, toward[hit], of_stop)
    c = np.where(before, start, stop)
    inside = b * b - square * c
    ends = -(b + np.sqrt(np.maximum(inside, 0.0))) / square
    depths = np.where(round_end, ends, depths)
    met = (~round_end | (inside >= 0.0)) & (depths > _NEAREST)
    hit[hit] = met
    return hit, depths[met]


def _boxes(
    body: BodyModel, frames: Array, camera: Camera
) -> tuple[Integers, Integers, Integers]:
    """List every pixel of every capsule's bounding box: capsule, column and row of each."""
    frame = frames[CAPSULE_SEGMENTS]
    ends = np.einsum("nij,nej->nei", frame[:, :3, :3], body.capsule_ends)
    ends += frame[:, np.newaxis, :3, 3]
    radii = body.radii.max(axis=1)[:, np.newaxis]
    before = (ends[..., 2] > radii + _NEAREST).all(axis=1)
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
    sideways: Array, forward: Array, radii: Array, focal: float, centre: float, size: int
) -> tuple[Integers, Integers]:
    """Return the first and last pixel between the tangents to the balls at both ends."""
    safe = np.maximum(forward, radii + _NEAREST)
    root = radii * np.sqrt(sideways**2 + safe**2 - radii**2)
    low = (sideways * safe - root) / (safe**2 - radii**2)
    high = (sideways * safe + root) / (safe**2 - radii**2)
    first = np.ceil(focal * low.min(axis=1) + centre)
    last = np.floor(focal * high.max(axis=1) + centre)
    return (
        np.clip(first, 0, size).astype(np.intp),
        np.clip(last, -1, size - 1).astype(np.intp),
    )


def _front(camera: Camera, pixels: Integers, depths: Array, capsules: Integers) -> BodyImage:
    """Keep what is nearest in each pixel; of the equally near the first capsule."""
    nearest = np.full(camera.width * camera.height, np.inf)
    np.minimum.at(nearest, pixels, depths)
    front = depths == nearest[pixels]
    pixels, depths, capsules = pixels[front], depths[front], capsules[front]
    first = np.full(len(nearest), NOTHING)
    first[pixels[::-1]] = np.arange(len(pixels))[::-1]
    once = first[pixels] == np.arange(len(pixels))
    return BodyImage(camera, pixels[once], depths[once], capsules[once])
