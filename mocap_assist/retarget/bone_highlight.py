"""Select both bones of a row of the bone list, and draw them over the 3D View."""

from collections.abc import Iterator

import bpy
import numpy as np

from ...solvers.arrays import Single
from ..blender.redrawing import redraw_views
from ..overlays.view_drawing import Color, ViewDrawing, draw_lines
from ..panel_parts.preference_values import preference_value
from ..panel_parts.sidebar_tab import is_tab_open
from ..runtime.selection import select_only_bone
from .bone_map import LISTED_ARMATURES, listed_armature

SWITCH = "mocap_assist_highlight"
COLOR: Color = (1.0, 0.25, 0.85, 1.0)
"""No other drawing has this color."""
WIDTH_FACTOR = 3.0
"""Line width relative to the comparison overlay, so that it shows through a mesh."""
_drawing: list[ViewDrawing] = []


def why_certain(row: bpy.types.PropertyGroup, side: str) -> str:
    """Return a sentence about the confidence in a bone of a row, or an empty text."""
    reason = getattr(row, f"{side}_reason")
    if not (getattr(row, side) and reason):
        return ""
    confidence = getattr(row, f"{side}_confidence")
    return f"{side.capitalize()}: {confidence:.0%}, {reason}."


def show_pair(listed: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Select both bones of the active row: the update of a click."""
    for armature, bone in _pair(context):
        select_only_bone(armature, bone)


def _pair(context: bpy.types.Context) -> Iterator[tuple[bpy.types.Object, str]]:
    """Yield both armatures of the list with their bones of the active row."""
    listed = context.scene.mocap_assist.bone_map
    if not 0 <= listed.active_row < len(listed.rows):
        return
    row = listed.rows[listed.active_row]
    for side in LISTED_ARMATURES:
        armature, bone = listed_armature(listed, side), getattr(row, side)
        if armature is not None and bone in armature.pose.bones:
            yield armature, bone


def highlighted_bones(context: bpy.types.Context) -> list[tuple[bpy.types.Object, Single]]:
    """Return armatures with the line from head to tail of their bone, shape (1, 2, 3).

    Only while one of both is active, so that an old list draws nothing.
    """
    pair = list(_pair(context))
    if context.view_layer.objects.active not in [armature for armature, _ in pair]:
        return []
    ends = [armature.pose.bones[bone] for armature, bone in pair]
    return [
        (armature, np.array([[bone.head, bone.tail]], np.float32))
        for (armature, _), bone in zip(pair, ends, strict=True)
    ]


def _draw(context: bpy.types.Context) -> None:
    if not getattr(context.window_manager, SWITCH) or not is_tab_open(context.screen):
        return
    width = WIDTH_FACTOR * preference_value("line_width")
    for armature, line in highlighted_bones(context):
        if armature.visible_get(viewport=context.space_data):
            draw_lines(line, armature.matrix_world, COLOR, width)


def register() -> None:
    """Add the switch, which starts on."""
    setattr(
        bpy.types.WindowManager,
        SWITCH,
        bpy.props.BoolProperty(
            name="Highlight",
            description="Draw both bones of the selected row over the 3D View",
            default=True,
            update=redraw_views,
        ),
    )
    _drawing.append(ViewDrawing(_draw))


def unregister() -> None:
    """Remove the switch and the drawing."""
    _drawing.pop().close()
    delattr(bpy.types.WindowManager, SWITCH)
