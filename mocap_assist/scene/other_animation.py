"""Whether anything in a scene is animated, so that its frame rate must stay."""

from collections.abc import Iterable, Iterator

import bpy

from ..blender import compat
from .origin import ORIGIN

CACHES = {"MESH_SEQUENCE_CACHE", "TRANSFORM_CACHE"}
"""Modifiers and constraints that play files of Alembic and USD."""


def is_animated(scene: bpy.types.Scene) -> bool:
    """Return whether another frame rate would change what a scene shows.

    Keys and NLA strips of its objects, their data and materials, depth recordings, caches,
    video strips, a movie clip and timeline markers count. Actions that nothing plays do not.
    """
    editor = scene.sequence_editor
    if scene.timeline_markers or scene.active_clip or (editor and editor.strips):
        return True
    objects = {*scene.objects}
    for each in scene.objects:
        if each.instance_collection is not None:
            objects |= {*each.instance_collection.all_objects}
    return any(map(_plays_file, objects)) or any(map(_is_keyed, _owners(scene, objects)))


def _owners(
    scene: bpy.types.Scene, objects: Iterable[bpy.types.Object]
) -> Iterator[bpy.types.ID]:
    """Yield all that may have keys."""
    yield scene
    if scene.world is not None:
        yield scene.world
    for each in objects:
        yield each
        if each.data is not None:
            yield each.data
        if keys := getattr(each.data, "shape_keys", None):
            yield keys
        for slot in each.material_slots:
            if slot.material is not None:
                yield slot.material
                if slot.material.node_tree is not None:
                    yield slot.material.node_tree


def _is_keyed(owner: bpy.types.ID) -> bool:
    animation = getattr(owner, "animation_data", None)
    if animation is None:
        return False
    if any(track.strips for track in animation.nla_tracks):
        return True
    if animation.action is None or animation.action_slot is None:
        return False
    bag = compat.channelbag(animation.action, animation.action_slot)
    return bag is not None and any(len(curve.keyframe_points) for curve in bag.fcurves)


def _plays_file(each: bpy.types.Object) -> bool:
    if each.type == "MESH" and ORIGIN in each:
        return True
    return any(one.type in CACHES for one in (*each.modifiers, *each.constraints))
