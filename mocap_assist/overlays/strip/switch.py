"""Switch of the strip, and its legend; it is on the window manager, not in the scene."""

from typing import Any

import bpy
from bpy.types import SpaceDopeSheetEditor, SpaceGraphEditor

from ...blender.redrawing import redraw
from ...panel_parts.panel_layout import draw_sentence
from ...runtime.selection import selected_armature
from ..color_icons import draw_marks
from ..marked_ranges import MARKS, StripRow
from .drawing import EDITORS, draw_strip
from .reading import is_checked, strip_of

SWITCH = "mocap_assist_strip"
SPACES = (SpaceDopeSheetEditor, SpaceGraphEditor)
NOTHING = "Nothing to show yet. Run Clean or Check."
_handles: list[tuple[Any, Any]] = []


def draw_strip_switch(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the switch and, while it is on, the colors of the rows that the strip has now.

    Markers have no strip.
    """
    manager = context.window_manager
    if selected_armature(context) is None:
        return
    layout.prop(manager, SWITCH)
    if not manager.mocap_assist_strip:
        return
    strip = strip_of(context)
    if strip is None:
        if not is_checked(context):  # otherwise the list says that there are no issues
            draw_sentence(layout, context, NOTHING, icon="INFO")
        return
    column = layout.column(align=True)
    if StripRow.CONFIDENCE in strip.rows:
        column.label(text=StripRow.CONFIDENCE.value)
        draw_marks(column, MARKS[StripRow.CONFIDENCE], columns=3)
    others = (
        mark for row in strip.rows if row is not StripRow.CONFIDENCE for mark in MARKS[row]
    )
    draw_marks(column, dict.fromkeys(others), columns=2)


def _redraw_strips(self: bpy.types.WindowManager, context: bpy.types.Context) -> None:
    for editor in EDITORS:
        redraw(context, editor)


def _draw() -> None:
    context = bpy.context
    if context.window_manager.mocap_assist_strip:
        draw_strip(context)


def register() -> None:
    """Add the switch, which starts on: the strip is drawn only where there is a result."""
    bpy.types.WindowManager.mocap_assist_strip = bpy.props.BoolProperty(
        name="Timeline Strip",
        description=(
            "Show issues, changed frames, confidence and foot contacts below the keys of the"
            " armature"
        ),
        default=True,
        update=_redraw_strips,
    )
    _handles.extend(
        (space, space.draw_handler_add(_draw, (), "WINDOW", "POST_PIXEL")) for space in SPACES
    )


def unregister() -> None:
    """Remove the switch and the drawing."""
    while _handles:
        space, handle = _handles.pop()
        space.draw_handler_remove(handle, "WINDOW")
    del bpy.types.WindowManager.mocap_assist_strip
