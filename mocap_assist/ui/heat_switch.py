"""The switch of the heat colours: on the window manager, so that the scene stays as it is."""

from typing import Any

import bpy
import gpu
import numpy as np
from bpy.types import SpaceView3D

from ..scene.heat import Heat, heat_at
from ..scene.overlay_drawing import refresh
from .preferences import preferred

WIDER = 2.0
"""Times as wide as the lines of the overlay, for they lie upon the bones."""
_handle: list[Any] = []


def _switched(self: bpy.types.WindowManager, context: bpy.types.Context) -> None:
    refresh()


def _draw() -> None:
    context = bpy.context
    armature = context.view_layer.objects.active
    if (
        not context.window_manager.mocap_assist_heat
        or not context.space_data.overlay.show_overlays
    ):
        return
    if armature is None or armature.type != "ARMATURE":
        return
    heat = heat_at(armature, context.scene.frame_current_final)
    if heat is not None:
        _draw_heat(heat, armature.matrix_world, WIDER * preferred("line_width"))


def _draw_heat(heat: Heat, matrix: Any, width: float) -> None:
    """Draw bones and joints in front of everything."""
    from gpu_extras.batch import batch_for_shader

    points = np.ascontiguousarray(heat.ends.reshape(-1, 3))
    colors = np.ascontiguousarray(heat.colors.reshape(-1, 4))
    lines = gpu.shader.from_builtin("POLYLINE_SMOOTH_COLOR")
    batch = batch_for_shader(lines, "LINES", {"pos": points, "color": colors})
    lines.bind()
    lines.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    lines.uniform_float("lineWidth", width)
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set("NONE")
    with gpu.matrix.push_pop():
        gpu.matrix.multiply_matrix(matrix)
        batch.draw(lines)
    gpu.state.blend_set("NONE")


def register() -> None:
    """Add the switch; nothing is drawn until it is on."""
    bpy.types.WindowManager.mocap_assist_heat = bpy.props.BoolProperty(
        name="Trust in Colours",
        description=(
            "Draw the bones of a reconstructed action in the colours of how far their joints"
            " were trusted at the present frame: blue was trusted, red was not"
        ),
        update=_switched,
    )
    _handle.append(SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_VIEW"))


def unregister() -> None:
    """Take the switch and the drawing away."""
    SpaceView3D.draw_handler_remove(_handle.pop(), "WINDOW")
    del bpy.types.WindowManager.mocap_assist_heat
