"""Let an animator see what came in: the views framed on it, and its bones in Pose Mode."""

import bpy

from ..actions.armature_build import select_root

IN_CAMERA = "CAMERA"


def show_actor(context: bpy.types.Context) -> None:
    """Frame the 3D views of a window on what is selected, and enter Pose Mode.

    Views through a camera stay: they belong to a shot.
    """
    context.view_layer.update()
    window = context.window
    for area in window.screen.areas if window is not None else ():
        if area.type != "VIEW_3D" or area.spaces.active.region_3d is None:
            continue
        if area.spaces.active.region_3d.view_perspective == IN_CAMERA:
            continue
        region = next(each for each in area.regions if each.type == "WINDOW")
        with context.temp_override(window=window, area=area, region=region):
            if bpy.ops.view3d.view_selected.poll():
                bpy.ops.view3d.view_selected()
    active, switch = context.view_layer.objects.active, bpy.ops.object.mode_set
    if active is None or active.type != "ARMATURE" or not switch.poll():
        return
    switch(mode="POSE")
    for armature in context.objects_in_mode:
        select_root(armature)
