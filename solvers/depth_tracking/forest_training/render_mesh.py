"""Depth and parts of a mesh as a camera sees it, by a z-buffer over all triangles at once."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import Camera

Array = NDArray[np.float64]
NO_PART = 255
"""Label of pixels that see no body."""
NEAR = 0.05
"""Metres. Triangles with a corner nearer than this to the camera's plane are not drawn."""


class RenderedMesh(NamedTuple):
    """What a camera sees of a mesh."""

    depth: NDArray[np.float32]
    """Shape (height, width), metres along the optical axis; 0: nothing."""
    labels: NDArray[np.uint8]
    """Label of the nearest corner of the triangle that each pixel sees, or `NO_PART`."""


def render_mesh(
    vertices: Array, triangles: NDArray[np.int64], labels: NDArray[np.uint8], camera: Camera
) -> RenderedMesh:
    """Draw a mesh: exact depth where the middle of each pixel sees its nearest triangle.

    Parameters
    ----------
    vertices : shape (n_vertices, 3)
        In the camera's frame, metres.
    triangles : int array, shape (n_triangles, 3)
        Both sides are drawn.
    labels : uint8, shape (n_vertices,)
    camera : Camera
    """
    shape = (camera.height, camera.width)
    depth = np.zeros(shape[0] * shape[1], dtype=np.float32)
    parts = np.full(shape[0] * shape[1], NO_PART, dtype=np.uint8)
    ahead = vertices[:, 2] > NEAR
    drawn = triangles if ahead.all() else triangles[ahead[triangles].all(axis=1)]
    places = camera.project(vertices)
    pixel, which, shares = _covered(places[:, 0][drawn.T], places[:, 1][drawn.T], camera)
    corners = drawn[which].T
    nearness = shares / vertices[:, 2][corners]
    inverse = nearness.sum(axis=0)
    # The nearest of a pixel is the last written: numpy keeps the order of writing.
    order = np.argsort(inverse, kind="stable")
    depth[pixel[order]] = 1.0 / inverse[order]
    corner = corners[nearness.argmax(axis=0), np.arange(len(which))]
    parts[pixel[order]] = labels[corner[order]]
    return RenderedMesh(depth.reshape(shape), parts.reshape(shape))


def _covered(
    x: Array, y: Array, camera: Camera
) -> tuple[NDArray[np.int64], NDArray[np.int64], Array]:
    """Return pixels, triangles and shares of corners where a triangle covers a pixel's middle.

    Takes columns and rows of the corners (3, n); the shares are (3, n_covered).
    """
    left, right = _pixels_between(x, camera.width)
    top, bottom = _pixels_between(y, camera.height)
    wide, high = right - left + 1, bottom - top + 1
    drawn = np.flatnonzero((wide > 0) & (high > 0))
    counts = wide[drawn] * high[drawn]
    which = np.repeat(drawn, counts)
    step = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)
    row, column = np.divmod(step, wide[which])
    column += left[which]
    row += top[which]
    a, b, c = zip(x[:, which] - column, y[:, which] - row, strict=True)
    shares = np.stack([_area(b, c), _area(c, a), _area(a, b)])
    total = shares[0] + shares[1] + shares[2]
    inside = (total != 0.0) & ~((shares * np.sign(total)) < 0.0).any(axis=0)
    pixel = (row * camera.width + column)[inside]
    return pixel, which[inside], shares[:, inside] / total[inside]


def _pixels_between(corners: Array, size: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the first and last pixel whose middle lies between three corners (3, n)."""
    first = np.ceil(np.minimum(np.minimum(corners[0], corners[1]), corners[2]))
    last = np.floor(np.maximum(np.maximum(corners[0], corners[1]), corners[2]))
    first, last = np.maximum(first, 0.0), np.minimum(last, size - 1.0)
    return first.astype(np.int64), last.astype(np.int64)


def _area(a: tuple[Array, Array], b: tuple[Array, Array]) -> Array:
    """Return twice the signed area between vectors of the picture."""
    return a[0] * b[1] - a[1] * b[0]
