"""Wipe between two drawings: one left of a line in the 3D View, the other right of it."""

from collections.abc import Iterator
from contextlib import contextmanager

import gpu

LINE_COLOR = (0.9, 0.9, 0.9, 0.8)


@contextmanager
def clipped(position: float | None, *, left: bool) -> Iterator[None]:
    """Draw only left or right of a position, a fraction of the view's width; None: all."""
    if position is None:
        yield
        return
    before = gpu.state.scissor_get()
    gpu.state.scissor_test_set(True)
    gpu.state.scissor_set(*half_of(gpu.state.viewport_get(), position, left=left))
    try:
        yield
    finally:
        gpu.state.scissor_set(*before)
        gpu.state.scissor_test_set(False)


def half_of(
    viewport: tuple[int, int, int, int], position: float, *, left: bool
) -> tuple[int, int, int, int]:
    """Return x, y, width and height of one side of a viewport, in pixels."""
    x, y, width, height = viewport
    split = round(position * width)
    return (x, y, split, height) if left else (x + split, y, width - split, height)


def draw_wipe_line(position: float, width: float) -> None:
    """Draw the line between both sides from the bottom of the view to its top."""
    from gpu_extras.batch import batch_for_shader
    from mathutils import Matrix

    x = 2.0 * position - 1.0
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    batch = batch_for_shader(shader, "LINES", {"pos": [(x, -1.0, 0.0), (x, 1.0, 0.0)]})
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", width)
    shader.uniform_float("color", LINE_COLOR)
    gpu.state.blend_set("ALPHA")
    with gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
        gpu.matrix.load_matrix(Matrix.Identity(4))
        gpu.matrix.load_projection_matrix(Matrix.Identity(4))
        batch.draw(shader)
    gpu.state.blend_set("NONE")
