"""Make empties that follow recorded points: one action for all, a slot for each."""

import bpy

from ....solvers.arrays import Array
from ....solvers.motion import Tracks
from ....solvers.progress import Progress, unwatched
from ...blender import compat
from ...blender.data_names import fitting_name
from ...scene.scene_objects import add_object, add_unselected, in_object_mode
from ..new_action import write_channels

POINT = "mocap_assist_point"
"""Custom property of an empty: the name of its point, which Blender may have to change."""
MARKER_RADIUS_M = 0.015
"""Radius in meters of the sphere that shows a marker."""
CROSS_RADIUS_M = 0.2
"""Half the length, in meters, of the cross that shows the parent of the markers."""


def build_empties(
    context: bpy.types.Context,
    name: str,
    points: tuple[str, ...],
    meters: float,
    collection: bpy.types.Collection | None = None,
) -> tuple[bpy.types.Object, tuple[bpy.types.Object, ...]]:
    """Add an empty for each point, and a parent empty, which becomes active.

    The one that holds them is not drawn: Blender draws a line from each object to a parent
    that is. With a collection they are added there, and the active object stays.

    Parameters
    ----------
    context : bpy.types.Context
    name : of the one that holds them
    points : names
    meters : length of one of the scene's units
    collection : bpy.types.Collection, optional
    """
    in_object_mode(context)
    holder = bpy.data.objects.new(fitting_name(name), None)
    holder.empty_display_size = CROSS_RADIUS_M / meters
    holder.instance_type, holder.show_instancer_for_viewport = "COLLECTION", False
    made = []
    for point in points:
        empty = bpy.data.objects.new(fitting_name(point), None)
        empty.empty_display_type = "SPHERE"
        empty.empty_display_size = MARKER_RADIUS_M / meters
        empty[POINT] = point
        empty.parent = holder
        made.append(empty)
        if collection is None:
            add_unselected(context, empty)
        else:
            collection.objects.link(empty)
    if collection is None:
        add_object(context, holder)
    else:
        collection.objects.link(holder)
    return holder, tuple(made)


def write_tracks(
    name: str,
    empties: tuple[bpy.types.Object, ...],
    tracks: Tracks,
    frames: Array,
    meters: float,
    *,
    progress: Progress = unwatched,
) -> bpy.types.Action:
    """Animate empties by points, in one new action; gaps have no keys.

    Parameters
    ----------
    name : of the action
    empties : one for each point
    tracks : Tracks
    frames : shape (n_frames,), scene frames
    meters : length of one of the scene's units
    progress : Progress

    Returns
    -------
    bpy.types.Action
    """
    action = bpy.data.actions.new(name)
    action.use_fake_user = True
    for point, empty in enumerate(empties):
        progress(point / len(empties), "Writing keys")
        slot = action.slots.new("OBJECT", fitting_name(tracks.names[point]))
        bag = compat.ensure_channelbag(action, slot)
        positions = tracks.positions[:, point] / meters
        write_channels(bag, "location", "Location", frames, positions)
        compat.assign(empty, action, slot)
    return action
