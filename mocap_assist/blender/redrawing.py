"""Redraw areas of the window."""

import bpy


def redraw(context: bpy.types.Context, kind: str = "") -> None:
    """Redraw all areas, or those of a kind, for example VIEW_3D."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if kind in {"", area.type}:
                area.tag_redraw()


def redraw_views(_: bpy.types.WindowManager, context: bpy.types.Context) -> None:
    """Redraw the 3D Views, as `update` of a property."""
    redraw(context, "VIEW_3D")
