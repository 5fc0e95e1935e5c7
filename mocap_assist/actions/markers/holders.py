"""Empties that move as captured markers do, and the object that holds those of one take."""

import bpy

from ....solvers.errors import InvalidMotionError
from ...blender import compat
from ...blender.compat import Source
from ...scene import history
from .empties import POINT

PATH = "location"
STICKS = "mocap_assist_sticks"
"""Custom property of the mesh object that connects markers of a known set."""


def holder_of(active: bpy.types.Object | None) -> bpy.types.Object | None:
    """Return the parent of a take's markers: the active empty, or its parent; or None.

    The parent is also found by the sticks between the markers.
    """
    if active is None or (active.type != "EMPTY" and STICKS not in active):
        return None
    for each in (active, active.parent):
        if each is not None and any(map(is_marker, each.children)):
            return each
    return None


def markers_of(holder: bpy.types.Object) -> tuple[bpy.types.Object, ...]:
    """Return the markers below a holder, in the order of their names in the outliner."""
    return tuple(filter(is_marker, holder.children))


def first_marker_of(holder: bpy.types.Object) -> bpy.types.Object:
    """Return one of the markers, fast enough for redraws; all play the same action."""
    return next(filter(is_marker, holder.children))


def is_marker(each: bpy.types.Object) -> bool:
    """Whether an object is an empty whose location is keyed."""
    if each.type != "EMPTY" or each.animation_data is None:
        return False
    source = assigned_to(each) or played_by(each)
    bag = None if source is None else compat.channelbag(*source)
    return bag is not None and bag.fcurves.find(PATH) is not None


def played_by(marker: bpy.types.Object) -> Source | None:
    """Return the result or action that a marker plays."""
    return history.played_result(marker) or assigned_to(marker)


def source_of(marker: bpy.types.Object) -> Source:
    """Return what a marker plays; raise InvalidMotionError where it plays nothing."""
    played = played_by(marker)
    if played is None:
        raise InvalidMotionError(f"{marker.name} has no action. Assign one to it.")
    return played


def assigned_to(marker: bpy.types.Object) -> Source | None:
    """Return the action and slot of a marker, ignoring NLA tracks."""
    animation = marker.animation_data
    if animation is None or animation.action is None or animation.action_slot is None:
        return None
    return animation.action, animation.action_slot


def point_names(markers: tuple[bpy.types.Object, ...]) -> tuple[str, ...]:
    """Return the markers' names in the recording; their objects' names if ambiguous."""
    names = tuple(str(each.get(POINT, each.name)) for each in markers)
    return names if len(set(names)) == len(names) else tuple(each.name for each in markers)
