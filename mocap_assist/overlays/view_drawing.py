"""Draw handlers of the 3D Views, and lines in front of all objects."""

from collections.abc import Callable
from typing import Any

import bpy
import gpu
import numpy as np
from bpy.types import SpaceView3D
from numpy.typing import NDArray

Color = tuple[float, float, float, float]


class ViewDrawing:
    """Calls `draw` for every redraw of a 3D View with overlays, until it is closed.

    In the space of the scene, or, `in_pixels`, of the region.
    """

    def __init__(
        self, draw: Callable[[bpy.types.Context], None], *, in_pixels: bool = False
    ) -> None:
        self._draw = draw
        kind = "POST_PIXEL" if in_pixels else "POST_VIEW"
        self._handle: Any = SpaceView3D.draw_handler_add(self._draw_view, (), "WINDOW", kind)

    @property
    def is_on(self) -> bool:
        """Whether the handler is active."""
        return self._handle is not None

    def close(self) -> None:
        """Remove the handler; a second call has no effect."""
        if self._handle is not None:
            SpaceView3D.draw_handler_remove(self._handle, "WINDOW")
            self._handle = None

    def _draw_view(self) -> None:
        context = bpy.context
        if context.space_data.overlay.show_overlays:
            self._draw(context)


def visible_active(context: bpy.types.Context) -> bpy.types.Object | None:
    """Return the active object unless it is hidden in the current 3D View."""
    active = context.view_layer.objects.active
    if active is None or not active.visible_get(viewport=context.space_data):
        return None
    return active


def draw_lines(
    lines: NDArray[np.floating[Any]], matrix: Any, color: Color, width: float
) -> None:
    """Draw lines of shape (n_lines, 2, 3) in the space of `matrix`, in front of all objects."""
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    points = np.ascontiguousarray(lines.reshape(-1, 3), dtype=np.float32)
    shader.bind()
    shader.uniform_float("color", color)
    draw_in_front(shader, {"pos": points}, matrix, width)


def draw_in_front(
    shader: Any, content: dict[str, NDArray[np.float32]], matrix: Any, width: float
) -> None:
    """Draw lines with a shader in front of all objects, `width` pixels wide."""
    from gpu_extras.batch import batch_for_shader

    batch = batch_for_shader(shader, "LINES", content)
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", width)
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set("NONE")
    with gpu.matrix.push_pop():
        gpu.matrix.multiply_matrix(matrix)
        batch.draw(shader)
    gpu.state.blend_set("NONE")
