"""Draw stick figures or markers over the 3D View; the scene is not changed."""

from collections.abc import Callable
from typing import Any

import bpy
import gpu
import numpy as np
from bpy.app import handlers
from mathutils import Matrix
from numpy.typing import NDArray

from ..actions.markers import holder_of
from . import marker_overlay, overlay, strip_drawing
from .view_drawing import ViewDrawing, redraw, visible_active

Color = tuple[float, float, float, float]

EDIT_PAUSE_S = 0.3
"""Seconds without an edit after which keys are read again. It bounds the work while a key is
dragged, which is an edit at each step."""

_drawing: list[ViewDrawing] = []


def start(draw_all: Callable[[bpy.types.Context], None]) -> None:
    """Call `draw_all` whenever a 3D View is drawn."""
    _drawing.append(ViewDrawing(draw_all))
    handlers.depsgraph_update_post.append(_changed)
    for each in _REPLACING:
        each.append(_replaced)


def stop() -> None:
    """Undo `start`."""
    for each in _REPLACING:
        each.remove(_replaced)
    handlers.depsgraph_update_post.remove(_changed)
    if bpy.app.timers.is_registered(refresh):
        bpy.app.timers.unregister(refresh)
    _drawing.pop().close()
    forget()


def forget() -> None:
    """Clear the caches, so that the next drawing reads the actions again."""
    overlay.forget()
    marker_overlay.forget()
    strip_drawing.forget()


def draw(context: bpy.types.Context, colors: tuple[Color, Color], width: float) -> None:
    """Draw the raw and clean poses of the active armature or markers at the current frame."""
    active = visible_active(context)
    if active is None:
        return
    if active.type == "ARMATURE":
        _draw_figures(active, context.scene.frame_current_final, colors, width)
    elif (holder := holder_of(active)) is not None:
        for played, color in zip(marker_overlay.raw_and_clean(holder), colors, strict=True):
            lines = marker_overlay.lines_at(played, context.scene)
            draw_lines(lines, Matrix.Identity(4), color, width)


def _draw_figures(
    armature: bpy.types.Object, frame: float, colors: tuple[Color, Color], width: float
) -> None:
    for source, color in zip(overlay.raw_and_clean(armature), colors, strict=True):
        if source is not None:
            lines = overlay.figures_at(armature, source, frame).segments(frame)
            draw_lines(lines, armature.matrix_world, color, width)


def draw_lines(
    lines: NDArray[np.floating[Any]], matrix: Any, color: Color, width: float
) -> None:
    """Draw lines of shape (n_lines, 2, 3) in the space of `matrix`, in front of all objects."""
    from gpu_extras.batch import batch_for_shader

    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    points = np.ascontiguousarray(lines.reshape(-1, 3), dtype=np.float32)
    batch = batch_for_shader(shader, "LINES", {"pos": points})
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", width)
    shader.uniform_float("color", color)
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set("NONE")
    with gpu.matrix.push_pop():
        gpu.matrix.multiply_matrix(matrix)
        batch.draw(shader)
    gpu.state.blend_set("NONE")


@handlers.persistent
def _changed(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Read keys and rest poses again after an edit, but not while they are dragged."""
    kinds = (bpy.types.Action, bpy.types.Armature)
    if not any(isinstance(update.id, kinds) for update in depsgraph.updates):
        return
    if bpy.app.timers.is_registered(refresh):
        bpy.app.timers.unregister(refresh)
    bpy.app.timers.register(refresh, first_interval=EDIT_PAUSE_S)


def refresh() -> None:
    """Read again, and redraw every editor of motion."""
    forget()
    for editor in ("VIEW_3D", *strip_drawing.EDITORS):
        redraw(bpy.context, editor)


@handlers.persistent
def _replaced(*_: object) -> None:
    """Clear the caches because undo, redo or loading replaced the data."""
    forget()


_REPLACING = (handlers.undo_post, handlers.redo_post, handlers.load_post)
