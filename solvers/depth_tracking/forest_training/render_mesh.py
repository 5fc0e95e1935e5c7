"""Render depth and parts of a mesh with a z-buffer over all triangles."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...depth_scene import Camera
from ..body import MIN_DEPTH_M

NO_PART = 255
"""Label of pixels off the body."""


class RenderedMesh(NamedTuple):
    """Rendered image of a mesh."""

    depth: NDArray[np.float32]
    """Shape (height, width), meters along the optical axis; 0: nothing."""
    labels: NDArray[np.uint8]
    """Label of the nearest corner of each pixel's triangle, or `NO_PART`."""


def render_mesh(
    vertices: Array, triangles: NDArray[np.int64], labels: NDArray[np.uint8], camera: Camera
) -> RenderedMesh:
    """Render a mesh: exact depth of the nearest triangle at each pixel center.

    Parameters
    ----------
    vertices : shape (n_vertices, 3)
        In the camera's frame, meters.
    triangles : int array, shape (n_triangles, 3)
        Both sides are rendered.
    labels : uint8, shape (n_vertices,)
    camera : Camera
    """
    shape = (camera.height, camera.width)
    depth = np.zeros(shape[0] * shape[1], dtype=np.float32)
    parts = np.full(shape[0] * shape[1], NO_PART, dtype=np.uint8)
    ahead = vertices[:, 2] > MIN_DEPTH_M
    rendered = triangles if ahead.all() else triangles[ahead[triangles].all(axis=1)]
    image_points = camera.project(vertices)
    pixels, triangle_indices, weights = _covered_pixels(
        image_points[:, 0][rendered.T], image_points[:, 1][rendered.T], camera
    )
    corners = rendered[triangle_indices].T
    inverse_depths = weights / vertices[:, 2][corners]
    inverse_depth = inverse_depths.sum(axis=0)
    # The nearest triangle of a pixel is written last; numpy keeps this order.
    order = np.argsort(inverse_depth, kind="stable")
    depth[pixels[order]] = 1.0 / inverse_depth[order]
    corner = corners[inverse_depths.argmax(axis=0), np.arange(len(triangle_indices))]
    parts[pixels[order]] = labels[corner[order]]
    return RenderedMesh(depth.reshape(shape), parts.reshape(shape))


def _covered_pixels(
    x: Array, y: Array, camera: Camera
) -> tuple[NDArray[np.int64], NDArray[np.int64], Array]:
    """Return covered pixels, their triangles and barycentric weights.

    Takes columns and rows of the corners (3, n); the weights are (3, n_covered).
    """
    left, right = _pixels_between(x, camera.width)
    top, bottom = _pixels_between(y, camera.height)
    widths, heights = right - left + 1, bottom - top + 1
    rendered = np.flatnonzero((widths > 0) & (heights > 0))
    counts = widths[rendered] * heights[rendered]
    triangle_indices = np.repeat(rendered, counts)
    step = np.arange(len(triangle_indices)) - np.repeat(np.cumsum(counts) - counts, counts)
    row, column = np.divmod(step, widths[triangle_indices])
    column += left[triangle_indices]
    row += top[triangle_indices]
    a, b, c = zip(x[:, triangle_indices] - column, y[:, triangle_indices] - row, strict=True)
    weights = np.stack([_area(b, c), _area(c, a), _area(a, b)])
    total = weights[0] + weights[1] + weights[2]
    inside = (total != 0.0) & ~((weights * np.sign(total)) < 0.0).any(axis=0)
    pixels = (row * camera.width + column)[inside]
    return pixels, triangle_indices[inside], weights[:, inside] / total[inside]


def _pixels_between(corners: Array, size: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the first and last pixel whose center is between three corners (3, n)."""
    first = np.ceil(np.minimum(np.minimum(corners[0], corners[1]), corners[2]))
    last = np.floor(np.maximum(np.maximum(corners[0], corners[1]), corners[2]))
    first, last = np.maximum(first, 0.0), np.minimum(last, size - 1.0)
    return first.astype(np.int64), last.astype(np.int64)


def _area(a: tuple[Array, Array], b: tuple[Array, Array]) -> Array:
    """Return twice the signed area between image vectors."""
    return a[0] * b[1] - a[1] * b[0]
