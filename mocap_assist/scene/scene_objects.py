"""Add objects to the scene, and remove them again after a failure."""

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from ..blender.data_names import fitting_name
from .scene_state import SceneState

Numbers = dict[str, set[int]]
"""Session numbers of data, by their kind."""
KINDS = ("objects", "armatures", "meshes", "node_groups", "actions", "collections")


def in_object_mode(context: bpy.types.Context) -> None:
    """Leave Pose or Edit Mode, so that another object can become active."""
    active = context.view_layer.objects.active
    switch = bpy.ops.object.mode_set
    if active is not None and active.mode != "OBJECT" and switch.poll():
        switch(mode="OBJECT")


def add_object(context: bpy.types.Context, made: bpy.types.Object) -> None:
    """Link an object where new ones go, and make it the only one that is selected."""
    add_unselected(context, made)
    select_only(context, [made], made)


def add_unselected(context: bpy.types.Context, made: bpy.types.Object) -> None:
    """Link an object where new ones go, without selecting it."""
    collection_for_new(context).objects.link(made)


def collection_for_new(context: bpy.types.Context) -> bpy.types.Collection:
    """Return the active collection if it is visible and local, otherwise the scene's."""
    active = context.view_layer.active_layer_collection
    hidden = active.exclude or active.hide_viewport or active.collection.hide_viewport
    usable = not hidden and active.is_visible and active.collection.is_editable
    return active.collection if usable else context.scene.collection


def hidden_collection(context: bpy.types.Context, name: str) -> bpy.types.Collection:
    """Add a collection where new objects go; its eye in the Outliner is closed."""
    made = bpy.data.collections.new(fitting_name(name))
    collection_for_new(context).children.link(made)
    layers = [context.view_layer.layer_collection]
    while layers:
        layer = layers.pop()
        if layer.collection == made:
            layer.hide_viewport = True
        layers += layer.children
    return made


def select_only(
    context: bpy.types.Context, chosen: list[bpy.types.Object], active: bpy.types.Object
) -> None:
    """Select these objects and no others."""
    for other in list(context.view_layer.objects.selected):
        other.select_set(False)
    for each in chosen:
        each.select_set(True)
    context.view_layer.objects.active = active


def session_numbers() -> Numbers:
    """Return the session numbers of all data of the kinds that this module makes."""
    return {kind: {each.session_uid for each in getattr(bpy.data, kind)} for kind in KINDS}


def remove_data(numbers: Numbers) -> None:
    """Remove the data with these session numbers that still exist."""
    for kind, unwanted in numbers.items():
        data = getattr(bpy.data, kind)
        bpy.data.batch_remove([each for each in data if each.session_uid in unwanted])


@contextmanager
def undo_on_error(context: bpy.types.Context) -> Iterator[Numbers]:
    """Restore the scene after an error; otherwise fill the yielded list."""
    state, before = SceneState.of(context), session_numbers()
    made: Numbers = {}
    try:
        yield made
    except BaseException:
        in_object_mode(context)
        remove_data(_new(before))
        state.restore(context)
        raise
    made.update(_new(before))


def _new(before: Numbers) -> Numbers:
    return {kind: numbers - before[kind] for kind, numbers in session_numbers().items()}
