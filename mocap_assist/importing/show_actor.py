"""Let an animator see what came in: the views framed on it, and its bones in Pose Mode."""

from collections.abc import Iterator
from typing import NamedTuple

import bpy
from mathutils import Matrix, Vector

from ..actions.armature_build import select_root

IN_CAMERA = "CAMERA"


def show_actor(context: bpy.types.Context) -> None:
    """Frame the 3D views of a window on what is selected, and enter Pose Mode.

    Views through a camera stay: they belong to a shot.
    """
    context.view_layer.update()
    for area in _views(context):
        region = next(each for each in area.regions if each.type == "WINDOW")
        with context.temp_override(window=context.window, area=area, region=region):
            if bpy.ops.view3d.view_selected.poll():
                bpy.ops.view3d.view_selected()
    active, switch = context.view_layer.objects.active, bpy.ops.object.mode_set
    if active is None or active.type != "ARMATURE" or not switch.poll():
        return
    switch(mode="POSE")
    for armature in context.objects_in_mode:
        select_root(armature)


class ViewPosition(NamedTuple):
    """Position of a 3D view."""

    location: Vector
    distance: float


def positions_of_views(context: bpy.types.Context) -> list[ViewPosition]:
    """Return the positions of the 3D views of a window."""
    views = (area.spaces.active.region_3d for area in _views(context))
    return [ViewPosition(view.view_location.copy(), view.view_distance) for view in views]


def follow_actor(
    context: bpy.types.Context, positions: list[ViewPosition], change: Matrix
) -> None:
    """Move 3D views from these positions as an actor was moved and scaled in the world."""
    for area, position in zip(_views(context), positions, strict=False):
        view = area.spaces.active.region_3d
        view.view_location = change @ position.location
        view.view_distance = position.distance * change.median_scale


def _views(context: bpy.types.Context) -> Iterator[bpy.types.Area]:
    """Yield the 3D views of a window that show no camera."""
    for area in context.window.screen.areas if context.window is not None else ():
        if area.type != "VIEW_3D" or area.spaces.active.region_3d is None:
            continue
        if area.spaces.active.region_3d.view_perspective != IN_CAMERA:
            yield area
