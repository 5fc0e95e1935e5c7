"""What animators may do while a solve runs: look, scrub, and press Cancel in the status bar.

These events reach Blender's editors; all others do not, so that nothing is edited meanwhile.
"""

from collections.abc import Iterable
from typing import Any

import bpy

ALWAYS = {
    "MOUSEMOVE", "MIDDLEMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE", "WHEELINMOUSE",
    "WHEELOUTMOUSE", "WHEELLEFTMOUSE", "WHEELRIGHTMOUSE", "TRACKPADPAN", "TRACKPADZOOM",
    "MOUSEROTATE", "MOUSESMARTZOOM", "NDOF_MOTION",
}  # fmt: skip
"""Events that move a view wherever the pointer is."""
MOTION_EDITORS = {"VIEW_3D", "DOPESHEET_EDITOR", "GRAPH_EDITOR", "NLA_EDITOR"}
IN_MOTION_EDITORS = {
    "LEFT_ARROW", "RIGHT_ARROW", "UP_ARROW", "DOWN_ARROW", "HOME", "NUMPAD_PLUS",
    "NUMPAD_MINUS", "NUMPAD_PERIOD", *(f"NUMPAD_{digit}" for digit in range(1, 10)),
}  # fmt: skip
"""Keys that move the view or the frame there; in lists and texts they do something else."""
SCRUBBED = MOTION_EDITORS - {"VIEW_3D"}
SCRUB_HEIGHT_PX = 23
"""Height of the numbers of the frames at interface scale 1, as Blender draws them."""


def may_pass(context: bpy.types.Context, event: bpy.types.Event) -> bool:
    """Return whether an event only moves a view or the frame, or is for the status bar."""
    if event.type == "LEFTMOUSE":
        return is_in_status_bar(context, event) or _is_on_frame_numbers(context, event)
    if event.ctrl or event.alt or event.oskey:  # with these, wheel and keys change values
        return bool(event.type == "MIDDLEMOUSE")
    if event.type in ALWAYS:
        return True
    return event.type in IN_MOTION_EDITORS and _view_below(context, event) is not None


def is_in_status_bar(context: bpy.types.Context, event: bpy.types.Event) -> bool:
    """Return whether an event of the pointer is below all editors: Cancel is there."""
    if event.type not in {"LEFTMOUSE", "MOUSEMOVE"}:
        return False
    return bool(event.mouse_y < min(area.y for area in context.screen.areas))


def _is_on_frame_numbers(context: bpy.types.Context, event: bpy.types.Event) -> bool:
    area, region = _at_pointer(context.screen.areas, event), _view_below(context, event)
    if region is None or area.type not in SCRUBBED:
        return False
    if event.shift or event.ctrl or event.alt:  # with these, a click selects keys
        return False
    height = SCRUB_HEIGHT_PX * context.preferences.system.ui_scale
    return bool(event.mouse_y >= region.y + region.height - height)


def _view_below(context: bpy.types.Context, event: bpy.types.Event) -> bpy.types.Region | None:
    """Return the view of a motion editor below the pointer; None on its bars and lists."""
    area = _at_pointer(context.screen.areas, event)
    if area is None or area.type not in MOTION_EDITORS:
        return None
    others = [region for region in area.regions if region.type != "WINDOW"]
    views = [region for region in area.regions if region.type == "WINDOW"]
    # Bars may lie over the view.
    return None if _at_pointer(others, event) else _at_pointer(views, event)


def _at_pointer(rectangles: Iterable[Any], event: bpy.types.Event) -> Any:
    for each in rectangles:
        inside_x = each.x <= event.mouse_x < each.x + each.width
        if inside_x and each.y <= event.mouse_y < each.y + each.height:
            return each
    return None
