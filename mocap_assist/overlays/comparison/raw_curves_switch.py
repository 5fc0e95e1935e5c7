"""Draw recorded curves in the Graph Editor; their switch is on the window manager."""

from contextlib import suppress
from typing import Any

import bpy
import gpu
from bpy.types import SpaceGraphEditor

from ....solvers.errors import InvalidMotionError
from ...blender.redrawing import redraw
from ...panel_parts.preference_values import preference_value
from .raw_curves import CurvePair, curve_lines, displayed_values, shown_pairs

SWITCH = "mocap_assist_raw_curves"
OPACITY = 0.7
"""Of a recorded curve relative to the color of the recorded take."""
WIDTH_PX = 2.0
"""Width of a recorded curve at interface scale 1; Blender's own curves have 1 to 2."""
MAX_CACHED = 128
"""Number of cached curves. It bounds the memory: of 10,000 keys each has 240 kB."""
_handles: list[Any] = []
_batches: dict[tuple[tuple[int, int], str, int, int], Any] = {}


def forget() -> None:
    """Clear the cache, so that the next drawing reads again."""
    _batches.clear()


def draw_raw_curves(context: bpy.types.Context) -> None:
    """Draw the recorded curves of those that the Graph Editor shows, in frames and values."""
    space = context.space_data
    if space.mode != "FCURVES":
        return
    pairs = shown_pairs(context)
    if not pairs:
        return
    red, green, blue, alpha = preference_value("raw_color")
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    shader.bind()
    shader.uniform_float("color", (red, green, blue, OPACITY * alpha))
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", WIDTH_PX * context.preferences.system.ui_scale)
    gpu.state.blend_set("ALPHA")
    try:
        for pair in pairs:
            with suppress(InvalidMotionError):  # keys that no solver reads either
                _draw_pair(context, pair, shader)
    finally:
        gpu.state.blend_set("NONE")


def _draw_pair(context: bpy.types.Context, pair: CurvePair, shader: Any) -> None:
    """Draw a recorded curve at the height of the one that plays."""
    factor, offset = displayed_values(
        pair.played, context.scene, normalized=context.space_data.use_normalization
    )
    batch = _batch_of(pair, shader)
    with gpu.matrix.push_pop():
        gpu.matrix.translate((pair.time.start, offset))
        gpu.matrix.scale((pair.time.scale, factor))
        batch.draw(shader)


def _batch_of(pair: CurvePair, shader: Any) -> Any:
    """Return the lines of a recorded curve; they are made once until `forget`."""
    from gpu_extras.batch import batch_for_shader

    curve = pair.recorded
    key = pair.recorded_in, curve.data_path, curve.array_index, len(curve.keyframe_points)
    if key not in _batches:
        while len(_batches) >= MAX_CACHED:
            del _batches[next(iter(_batches))]
        lines = curve_lines(curve)
        _batches[key] = batch_for_shader(shader, "LINES", {"pos": lines.reshape(-1, 3)})
    return _batches[key]


def _redraw_graphs(self: bpy.types.WindowManager, context: bpy.types.Context) -> None:
    redraw(context, "GRAPH_EDITOR")


def _draw() -> None:
    context = bpy.context
    if getattr(context.window_manager, SWITCH):
        draw_raw_curves(context)


def register() -> None:
    """Add the switch, which starts on: curves are drawn only where a result plays."""
    described = bpy.props.BoolProperty(
        name="Raw Curves",
        description="Draw the recorded curves behind those of the result in the Graph Editor",
        default=True,
        update=_redraw_graphs,
    )
    setattr(bpy.types.WindowManager, SWITCH, described)
    _handles.append(SpaceGraphEditor.draw_handler_add(_draw, (), "WINDOW", "PRE_VIEW"))


def unregister() -> None:
    """Remove the switch and the drawing."""
    SpaceGraphEditor.draw_handler_remove(_handles.pop(), "WINDOW")
    delattr(bpy.types.WindowManager, SWITCH)
    forget()
