"""Switch of the comparison overlay; it is on the window manager, not in the scene."""

import bpy

from ..panels.preference_values import preferred
from . import overlay_drawing


def _switched(self: bpy.types.WindowManager, context: bpy.types.Context) -> None:
    overlay_drawing.refresh()


def _draw(context: bpy.types.Context) -> None:
    if context.window_manager.mocap_assist_overlay:
        colors = (tuple(preferred("raw_color")), tuple(preferred("clean_color")))
        overlay_drawing.draw(context, colors, preferred("line_width"))


def register() -> None:
    """Add the switch, which starts off."""
    bpy.types.WindowManager.mocap_assist_overlay = bpy.props.BoolProperty(
        name="Compare Overlay",
        description=(
            "Draw the recorded and the cleaned motion over the 3D View; constraints are not"
            " evaluated"
        ),
        update=_switched,
    )
    overlay_drawing.start(_draw)


def unregister() -> None:
    """Remove the switch and the drawing."""
    overlay_drawing.stop()
    del bpy.types.WindowManager.mocap_assist_overlay
