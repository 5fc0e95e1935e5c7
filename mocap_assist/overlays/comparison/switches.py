"""Switches of the comparison overlay; they are on the window manager, not in the scene."""

import bpy

from ...blender.redrawing import redraw_views
from ...panel_parts.preference_values import preference_value, preferences
from . import drawing
from .onion_skin import Onion
from .raw_curves_switch import SWITCH as RAW_CURVES

PREFIX = "mocap_assist_"
SWITCHES = ("overlay", "onion", "wipe")


def draw_overlay_switches(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the switches and, while one is on, its colors and settings."""
    manager = context.window_manager
    column = layout.column(align=True)
    column.prop(manager, "mocap_assist_overlay", toggle=True, icon="OVERLAY")
    row = column.row(align=True)
    row.prop(manager, "mocap_assist_onion", toggle=True, icon="ONIONSKIN_ON")
    row.prop(manager, "mocap_assist_wipe", toggle=True, icon="ARROW_LEFTRIGHT")
    if manager.mocap_assist_onion:
        row = column.row(align=True)
        row.prop(manager, "mocap_assist_onion_ghosts")
        row.prop(manager, "mocap_assist_onion_step")
    if manager.mocap_assist_wipe:
        column.prop(manager, "mocap_assist_wipe_position", slider=True)
    column.prop(manager, RAW_CURVES, toggle=True, icon="FCURVE")
    is_on = any(getattr(manager, f"{PREFIX}{name}") for name in SWITCHES)
    is_graph = context.area is not None and context.area.type == "GRAPH_EDITOR"
    if (is_on or (is_graph and getattr(manager, RAW_CURVES))) and preferences() is not None:
        _draw_colors(column)


def _draw_colors(column: bpy.types.UILayout) -> None:
    colors = column.row(align=True)
    for color in ("raw_color", "clean_color"):
        colors.prop(preferences(), color, text="")
    names = column.row(align=True)
    for text in ("Raw Color", "Clean Color"):
        name = names.row()
        name.alignment = "CENTER"
        name.label(text=text)


def _refresh_drawing(self: bpy.types.WindowManager, context: bpy.types.Context) -> None:
    drawing.refresh()


def current_look(manager: bpy.types.WindowManager) -> drawing.Look:
    """Return the look that the switches and preferences choose."""
    onion = Onion(manager.mocap_assist_onion_ghosts, manager.mocap_assist_onion_step)
    is_wiped = manager.mocap_assist_wipe
    return drawing.Look(
        colors=(tuple(preference_value("raw_color")), tuple(preference_value("clean_color"))),
        width=preference_value("line_width"),
        has_poses=manager.mocap_assist_overlay or is_wiped,
        onion=onion if manager.mocap_assist_onion else None,
        wipe=manager.mocap_assist_wipe_position if is_wiped else None,
    )


def _draw(context: bpy.types.Context) -> None:
    look = current_look(context.window_manager)
    if look.has_poses or look.onion is not None:
        drawing.draw(context, look)


PROPERTIES = {
    "overlay": bpy.props.BoolProperty(
        name="Compare Overlay",
        description=(
            "Draw the recorded and the cleaned motion over the 3D View; constraints are not"
            " evaluated"
        ),
        update=_refresh_drawing,
    ),
    "onion": bpy.props.BoolProperty(
        name="Onion Skin",
        description="Draw ghosts of nearby frames and trails of hands and feet, raw and clean",
        update=_refresh_drawing,
    ),
    "onion_ghosts": bpy.props.IntProperty(
        name="Ghosts",
        description="Number of ghosts before and after the current frame",
        default=3,
        min=1,
        max=20,
        update=redraw_views,
    ),
    "onion_step": bpy.props.IntProperty(
        name="Step",
        description="Frames from one ghost to the next; higher also makes longer trails",
        default=5,
        min=1,
        max=50,
        update=redraw_views,
    ),
    "wipe": bpy.props.BoolProperty(
        name="Wipe",
        description="Draw the recorded motion left of a line in the 3D View, the clean right",
        update=_refresh_drawing,
    ),
    "wipe_position": bpy.props.FloatProperty(
        name="Position",
        description="Position of the line between raw and clean, as a fraction of the width",
        subtype="FACTOR",
        default=0.5,
        min=0.0,
        max=1.0,
        update=redraw_views,
    ),
}


def register() -> None:
    """Add the switches, which start off."""
    for name, described in PROPERTIES.items():
        setattr(bpy.types.WindowManager, PREFIX + name, described)
    drawing.start(_draw)


def unregister() -> None:
    """Remove the switches and the drawing."""
    drawing.stop()
    for name in PROPERTIES:
        delattr(bpy.types.WindowManager, PREFIX + name)
