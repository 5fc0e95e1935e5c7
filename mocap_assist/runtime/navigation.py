"""What animators may do while a solve runs: look, scrub, and press Cancel in the status bar.

These events reach Blender's editors; all others do not, so that nothing is edited meanwhile.
"""

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
        return _is_in_status_bar(context, event) or _is_on_frame_numbers(context, event)
    if event.ctrl or event.alt or event.oskey:  # with these, wheel and keys change values
        return bool(event.type == "MIDDLEMOUSE")
    if event.type in ALWAYS:
        return True
    area = _area_below(context, event)
    return area is not None and area.type in MOTION_EDITORS and event.type in IN_MOTION_EDITORS


def _is_in_status_bar(context: bpy.types.Context, event: bpy.types.Event) -> bool:
    """Return whether the pointer is below all editors."""
    return bool(event.mouse_y < min(area.y for area in context.screen.areas))


def _is_on_frame_numbers(context: bpy.types.Context, event: bpy.types.Event) -> bool:
    area = _area_below(context, event)
    if area is None or area.type not in SCRUBBED:
        return False
    height = SCRUB_HEIGHT_PX * context.preferences.system.ui_scale
    for region in area.regions:
        if region.type == "WINDOW":
            top = region.y + region.height
            inside_x = region.x <= event.mouse_x < region.x + region.width
            return bool(inside_x and top - height <= event.mouse_y < top)
    return False


def _area_below(context: bpy.types.Context, event: bpy.types.Event) -> bpy.types.Area | None:
    for area in context.screen.areas:
        inside_x = area.x <= event.mouse_x < area.x + area.width
        if inside_x and area.y <= event.mouse_y < area.y + area.height:
            return area
    return None
