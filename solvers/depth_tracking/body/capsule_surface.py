"""Triangle mesh of the body surface, for display."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from .model import BodyModel
from .tables import CAPSULE_SEGMENTS


class BodySurface(NamedTuple):
    """Triangles on the capsules of a body, each in the frame of its segment.

    Attributes
    ----------
    vertices : shape (19, n_vertices, 3), meters
        Vertices of each capsule.
    normals : shape (19, n_vertices, 3)
        Outward unit normals.
    triangles : int, shape (n_triangles, 3)
        Vertices of one capsule, anticlockwise as seen from outside; the same for all.
    """

    vertices: Array
    normals: Array
    triangles: NDArray[np.intp]

    def at_pose(self, frames: Array) -> tuple[Array, Array]:
        """Return vertices and normals (19, n_vertices, 3) for segment transforms (17, 4, 4)."""
        rotations = frames[CAPSULE_SEGMENTS, :3, :3].swapaxes(1, 2)
        origins = frames[CAPSULE_SEGMENTS, np.newaxis, :3, 3]
        return self.vertices @ rotations + origins, self.normals @ rotations


def capsule_surface(body: BodyModel, n_around: int = 14, n_rings: int = 4) -> BodySurface:
    """Return triangles on the capsules of a body.

    In coordinates divided by the radii a capsule is a cylinder of radius 1 with half spheres
    at its ends.

    Parameters
    ----------
    body : BodyModel
    n_around : int
        Vertices around a capsule.
    n_rings : int
        Rings of each half sphere, its pole included.
    """
    scales = body.radii[:, np.newaxis, [0, 1, 1]]
    starts, stops = np.swapaxes(body.capsule_ends / scales, 0, 1)[:, :, np.newaxis]
    sphere, is_upper = _two_half_spheres(n_around, n_rings)
    out = sphere @ _bases((stops - starts)[:, 0])
    vertices = (np.where(is_upper[:, np.newaxis], stops, starts) + out) * scales
    normals = out / scales
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    return BodySurface(vertices, normals, _triangles(n_around, 2 * n_rings))


def _two_half_spheres(n_around: int, n_rings: int) -> tuple[Array, NDArray[np.bool_]]:
    """Return unit vectors, ring by ring from -Z to Z, and the mask of the upper half."""
    down = np.linspace(-np.pi / 2.0, 0.0, n_rings)
    heights = np.concatenate([down, -down[::-1]])
    around = np.arange(n_around) * (2.0 * np.pi / n_around)
    height, angle = (one.ravel() for one in np.meshgrid(heights, around, indexing="ij"))
    radius_at_height = np.cos(height)
    unit = np.stack(
        [radius_at_height * np.cos(angle), radius_at_height * np.sin(angle), np.sin(height)],
        axis=-1,
    )
    return unit, np.repeat(np.arange(2 * n_rings) >= n_rings, n_around)


def _bases(axes: Array) -> Array:
    """Return rotations (n, 3, 3) whose rows are x, y, z, with z along these axes (n, 3)."""
    z = axes / np.linalg.norm(axes, axis=-1, keepdims=True)
    x = np.cross(np.eye(3)[np.abs(z).argmin(axis=-1)], z)
    x /= np.linalg.norm(x, axis=-1, keepdims=True)
    return np.stack([x, np.cross(z, x), z], axis=1)


def _triangles(n_around: int, n_rings: int) -> NDArray[np.intp]:
    """Return the triangles between neighboring rings; those at the poles are flat."""
    row, column = np.meshgrid(np.arange(n_rings - 1), np.arange(n_around), indexing="ij")
    current = row * n_around + column
    next_column = row * n_around + (column + 1) % n_around
    pairs = [
        np.stack([current, next_column, next_column + n_around], axis=-1),
        np.stack([current, next_column + n_around, current + n_around], axis=-1),
    ]
    return np.concatenate([pair.reshape(-1, 3) for pair in pairs])
