"""Skinned bodies with skin, hair, shirt, trousers and shoes, as a color camera sees them."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from solvers.arrays import Array
from solvers.depth_scene.camera import Camera
from solvers.depth_tracking.forest.parts import PARTS
from solvers.depth_tracking.forest_training.render_mesh import NO_PART, render_mesh
from solvers.depth_tracking.forest_training.skinned_body import SkinnedBody

MATERIALS = np.array([
    [196.0, 148.0, 122.0], [58.0, 42.0, 34.0], [172.0, 44.0, 40.0], [216.0, 206.0, 190.0],
    [48.0, 66.0, 112.0], [36.0, 32.0, 30.0],
])  # fmt: skip
"""Red, green and blue of skin, hair, two stripes of a shirt, trousers and shoes."""
_SKIN, _HAIR, _SHIRT, _STRIPE, _TROUSERS, _SHOES = range(len(MATERIALS))
STRIPE = 0.06
"""Meters from one edge of a stripe of the shirt to the next."""
SHADES = 40
"""Steps of brightness."""
AMBIENT = 0.45
LAMP = np.array([0.4, -0.75, -0.55]) / np.linalg.norm([0.4, -0.75, -0.55])
"""Direction to the light, in the camera's frame: above, right of and behind the camera."""
NOISE = 4.0
"""Standard deviation of a channel, of 255."""


class ColoredPicture(NamedTuple):
    """What a camera of depth and color sees."""

    depth: NDArray[np.float32]
    """Shape (height, width), meters; 0: nothing."""
    color: NDArray[np.uint8]
    """Shape (height, width, 3)."""


def vertex_materials(body: SkinnedBody) -> NDArray[np.intp]:
    """Return the row of `MATERIALS` of each vertex."""
    parts = np.array(PARTS)[body.vertex_parts]
    found = np.full(len(parts), _SKIN)
    stripes = np.floor(body.vertices[:, 2] / STRIPE).astype(int) % 2
    sleeves = np.char.endswith(parts, ("Shoulder")) | np.char.endswith(parts, "UpperArm")
    shirt = sleeves | np.isin(parts, ("spine", "chest"))
    found[shirt] = np.where(stripes[shirt] == 0, _SHIRT, _STRIPE)
    found[np.char.find(parts, "Leg") >= 0] = _TROUSERS
    found[parts == "hips"] = _TROUSERS
    found[np.char.endswith(parts, "Foot")] = _SHOES
    head = parts == "head"
    middle = body.vertices[head].mean(axis=0)
    back = (body.vertices - middle) @ np.array([0.0, 1.0, 1.0]) > 0.02
    found[head & back] = _HAIR
    return found


def colored_picture(
    body: SkinnedBody,
    materials: NDArray[np.intp],
    vertices: Array,
    camera: Camera,
    rng: np.random.Generator,
) -> ColoredPicture:
    """Draw a posed body, its vertices (n, 3) in the camera's frame, meters."""
    facing = posed_normals(vertices, body.triangles) @ LAMP
    bright = AMBIENT + (1.0 - AMBIENT) * np.maximum(facing, 0.0)
    shades = np.rint(bright * (SHADES - 1)).astype(int)
    labels = (materials * SHADES + shades).astype(np.uint8)
    rendered = render_mesh(vertices, body.triangles, labels, camera)
    material, shade = np.divmod(rendered.labels.astype(int), SHADES)
    color = MATERIALS[material % len(MATERIALS)] * (shade / (SHADES - 1.0))[..., np.newaxis]
    color[rendered.labels == NO_PART] = 0.0
    color += NOISE * rng.standard_normal(color.shape)
    return ColoredPicture(rendered.depth, color.clip(0.0, 255.0).astype(np.uint8))


def posed_normals(vertices: Array, triangles: NDArray[np.int64]) -> Array:
    """Return the outward normal at each vertex, shape (n, 3)."""
    a, b, c = vertices[triangles.T]
    faces = np.cross(b - a, c - a)
    normals = np.stack([
        sum(np.bincount(corner, faces[:, axis], len(vertices)) for corner in triangles.T)
        for axis in range(3)
    ], axis=1)  # fmt: skip
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    return normals
