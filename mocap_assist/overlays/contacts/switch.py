"""Switch of the rings under feet in contact; it is on the window manager."""

import bpy
import gpu
from mathutils import Matrix

from ...actions.contact_keys import PROPERTIES
from ...blender.redrawing import redraw_views
from ...panel_parts.preference_values import preference_value
from ..color_icons import draw_marks
from ..marked_ranges import CONTACT_ROWS
from ..view_drawing import ViewDrawing, draw_in_front, visible_active
from .rings import Rings, rings_at

SWITCH = "mocap_assist_contacts"
_drawing: list[ViewDrawing] = []


def draw_contact_switch(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the switch and, while it is on, the colors of the parts that can have a ring."""
    layout.prop(context.window_manager, SWITCH)
    armature = context.view_layer.objects.active
    if getattr(context.window_manager, SWITCH) and armature is not None:
        parts = zip(PROPERTIES, CONTACT_ROWS, strict=True)
        marks = [mark for name, (_, mark) in parts if name in armature]
        draw_marks(layout, dict.fromkeys(marks), columns=2)


def _draw(context: bpy.types.Context) -> None:
    if not getattr(context.window_manager, SWITCH):
        return
    armature = visible_active(context)
    if armature is None or armature.type != "ARMATURE":
        return
    rings = rings_at(armature, context.scene.frame_current_final)
    if rings is not None:
        _draw_rings(rings)


def _draw_rings(rings: Rings) -> None:
    shader = gpu.shader.from_builtin("POLYLINE_SMOOTH_COLOR")
    content = {"pos": rings.lines.reshape(-1, 3), "color": rings.colors.reshape(-1, 4)}
    draw_in_front(shader, content, Matrix.Identity(4), preference_value("line_width"))


def register() -> None:
    """Add the switch, which starts on: rings are drawn only where contacts are keyed."""
    bpy.types.WindowManager.mocap_assist_contacts = bpy.props.BoolProperty(
        name="Show Contacts",
        description="Draw a ring under each foot, hand or knee while its contact key is 1",
        default=True,
        update=redraw_views,
    )
    _drawing.append(ViewDrawing(_draw))


def unregister() -> None:
    """Remove the switch and the drawing."""
    _drawing.pop().close()
    del bpy.types.WindowManager.mocap_assist_contacts
