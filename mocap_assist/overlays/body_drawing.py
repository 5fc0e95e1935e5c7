"""Draw the surface of a body over the 3D View; the scene is not changed."""

from typing import Any, NamedTuple

import gpu
import numpy as np
from numpy.typing import NDArray

from ...solvers.arrays import Array
from ...solvers.depth_tracking.body import BodySurface

EDGE_BRIGHTNESS = 0.45
"""Brightness of a surface seen edge-on, as a fraction of one that faces the eye."""
MIN_NORMAL_LENGTH = 1e-30
"""Length below which a normal has no direction, as that of a capsule without a radius, meters.
It guards a division."""


class Solid(NamedTuple):
    """Triangles in the scene, ready to be drawn.

    Attributes
    ----------
    points : shape (n_points, 3)
    normals : shape (n_points, 3)
    colors : shape (n_points, 4)
    triangles : int, shape (n_triangles, 3)
    """

    points: NDArray[np.float32]
    normals: NDArray[np.float32]
    colors: NDArray[np.float32]
    triangles: NDArray[np.int32]


def place_capsules(
    surface: BodySurface, vertices: Array, normals: Array, matrix: Array, colors: Array
) -> Solid:
    """Return the capsules of a body in the scene.

    Normals of mirrored capsules face outward too; those of capsules scaled to zero are 0.

    Parameters
    ----------
    surface : BodySurface
    vertices : shape (n_capsules, n_vertices, 3)
    normals : shape (n_capsules, n_vertices, 3)
    matrix : shape (4, 4)
        From the space of the surface to the scene.
    colors : shape (n_capsules, 4)
    """
    n_capsules, n_vertices, _ = vertices.shape
    x, y, z = matrix[:3, :3].T
    cofactors = np.stack([np.cross(y, z), np.cross(z, x), np.cross(x, y)])
    side = -1 if np.linalg.det(matrix[:3, :3]) < 0.0 else 1
    scene_normals = side * normals.reshape(-1, 3) @ cofactors
    lengths = np.linalg.norm(scene_normals, axis=-1, keepdims=True)
    scene_normals /= np.maximum(lengths, MIN_NORMAL_LENGTH)
    triangles = surface.triangles[:, ::side] + n_vertices * np.arange(n_capsules)[:, None, None]
    return Solid(
        (vertices.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]).astype(np.float32),
        scene_normals.astype(np.float32),
        np.repeat(colors, n_vertices, axis=0).astype(np.float32),
        triangles.reshape(-1, 3).astype(np.int32),
    )


def colors_shaded_by_view(drawn: Solid, eye_from_world: Array) -> NDArray[np.float32]:
    """Return the color of each point, (n_points, 4), darker where it faces sideways."""
    facing = np.abs(drawn.normals @ eye_from_world[2, :3]).astype(np.float32)
    colors = drawn.colors.copy()
    colors[:, :3] *= (EDGE_BRIGHTNESS + (1.0 - EDGE_BRIGHTNESS) * facing)[:, np.newaxis]
    return colors


def batch_of(drawn: Solid, view: Any) -> Any:
    """Return the triangles as a GPU batch, shaded for a region's `view`."""
    from gpu_extras.batch import batch_for_shader

    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    colors = colors_shaded_by_view(drawn, np.array(view.view_matrix))
    return batch_for_shader(
        shader, "TRIS", {"pos": drawn.points, "color": colors}, indices=drawn.triangles
    )


def draw_solid(drawn: Solid, view: Any) -> None:
    """Draw the body in a 3D View, with a depth test against its region's `view`."""
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    batch = batch_of(drawn, view)
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set("LESS_EQUAL")
    gpu.state.depth_mask_set(True)
    gpu.state.face_culling_set("BACK")
    batch.draw(shader)
    gpu.state.face_culling_set("NONE")
    gpu.state.depth_mask_set(False)
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")
