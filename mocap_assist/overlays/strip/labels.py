"""Labels of the strip's rows as an image, which is made once: letters are slow to draw."""

from typing import Any, NamedTuple

import blf
import gpu
from mathutils import Matrix

LABEL_PX, MARGIN_PX, BASELINE_PX = 10, 6, 3
"""Size of a label, its distance from the border and its height above the row's lower edge, in
pixels at scale 1."""
PLATE = (0.06, 0.06, 0.06, 0.85)
"""Behind the labels, over the ranges."""
LABEL_COLOR = (0.95, 0.95, 0.95, 1.0)
MAX_CACHED = 8
"""Number of cached images. It bounds the memory."""


class Labels(NamedTuple):
    """Names of rows from the top, and their size."""

    texts: tuple[str, ...]
    row_px: float
    """Height of a row, in pixels."""
    scale: float
    """Scale of the interface."""


class _Image(NamedTuple):
    texture: Any
    batch: Any
    size: tuple[int, int]


_images: dict[Labels, _Image] = {}


def forget() -> None:
    """Clear the cache."""
    _images.clear()


def draw_labels(labels: Labels, bottom: float) -> None:
    """Draw the labels at the left border of a region."""
    image = _images.get(labels)
    if image is None:
        while len(_images) >= MAX_CACHED:
            del _images[next(iter(_images))]
        image = _images[labels] = _make_image(labels)
    shader = gpu.shader.from_builtin("IMAGE")
    gpu.state.blend_set("ALPHA")
    with gpu.matrix.push_pop():
        gpu.matrix.translate((0.0, round(bottom)))
        gpu.matrix.scale(image.size)
        shader.bind()
        shader.uniform_sampler("image", image.texture)
        image.batch.draw(shader)
    gpu.state.blend_set("NONE")


def _make_image(labels: Labels) -> _Image:
    from gpu_extras.batch import batch_for_shader

    font, margin = 0, MARGIN_PX * labels.scale
    blf.size(font, LABEL_PX * labels.scale)
    blf.color(font, *LABEL_COLOR)
    longest = max(blf.dimensions(font, text)[0] for text in labels.texts)
    width = round(longest + 2 * margin)
    height = round(labels.row_px * len(labels.texts))
    texture = gpu.types.GPUTexture((width, height), format="RGBA8")
    buffer = gpu.types.GPUFrameBuffer(color_slots=texture)  # GPUOffScreen leaves the region
    with buffer.bind(), gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
        buffer.clear(color=PLATE)
        gpu.matrix.load_matrix(Matrix.Identity(4))
        to_screen = Matrix.Diagonal((2.0 / width, 2.0 / height, 1.0, 1.0))
        gpu.matrix.load_projection_matrix(Matrix.Translation((-1.0, -1.0, 0.0)) @ to_screen)
        for index, text in enumerate(reversed(labels.texts)):
            row = index * labels.row_px + BASELINE_PX * labels.scale
            blf.position(font, margin, row, 0.0)
            blf.draw(font, text)
    corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)]
    shader = gpu.shader.from_builtin("IMAGE")
    batch = batch_for_shader(shader, "TRI_STRIP", {"pos": corners, "texCoord": corners})
    return _Image(texture, batch, (width, height))
