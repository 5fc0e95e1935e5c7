"""Draw the ghost of the chosen match over the 3D Views."""

import bpy
from mathutils import Matrix

from ...solvers.arrays import Array
from ...solvers.errors import InvalidMotionError
from ..blender.redrawing import redraw_views
from ..overlays.view_drawing import Color, ViewDrawing, draw_lines
from . import searches
from .ghost import ghost_lines

COLOR: Color = (0.45, 0.95, 0.55, 0.95)
LINE_WIDTH_PX = 4.0

_drawing: list[ViewDrawing] = []


def ghost_now(context: bpy.types.Context) -> Array | None:
    """Return the lines of the ghost at this frame, in the scene's units; None without one."""
    try:
        search, found = searches.chosen_match(context)
    except InvalidMotionError:
        return None
    frame = (context.scene.frame_current_final - search.start) / search.step
    lines: Array = ghost_lines(search.finding.stage, found, frame) / search.meters
    return lines


def _draw(context: bpy.types.Context) -> None:
    if not context.window_manager.mocap_assist_ghost:
        return
    lines = ghost_now(context)
    if lines is not None:
        draw_lines(lines, Matrix.Identity(4), COLOR, LINE_WIDTH_PX)


def register() -> None:
    """Add the switch, which starts off."""
    bpy.types.WindowManager.mocap_assist_ghost = bpy.props.BoolProperty(
        name="Ghost",
        description=(
            "Draw the selected clip as a stick figure at the query, in the query's timing"
        ),
        update=redraw_views,
    )
    _drawing.append(ViewDrawing(_draw))


def unregister() -> None:
    """Remove the switch and the drawing."""
    _drawing.pop().close()
    del bpy.types.WindowManager.mocap_assist_ghost
