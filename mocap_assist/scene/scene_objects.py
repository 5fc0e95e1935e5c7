"""Objects that come into the scene, and that go again where something failed."""

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

KINDS = ("objects", "armatures", "actions", "collections")


def in_object_mode(context: bpy.types.Context) -> None:
    """Leave Pose or Edit Mode, in which no other object can become active."""
    active = context.view_layer.objects.active
    switch = bpy.ops.object.mode_set
    if active is not None and active.mode != "OBJECT" and switch.poll():
        switch(mode="OBJECT")


def add_object(context: bpy.types.Context, made: bpy.types.Object) -> None:
    """Link an object where new ones go, and make it the only one that is selected."""
    add_quietly(context, made)
    choose(context, [made], made)


def add_quietly(context: bpy.types.Context, made: bpy.types.Object) -> None:
    """Link an object where new ones go: the active collection, if it is seen and not linked."""
    layer = context.view_layer
    active = layer.active_layer_collection
    hidden = active.exclude or active.hide_viewport or active.collection.hide_viewport
    usable = not hidden and active.is_visible and active.collection.is_editable
    (active.collection if usable else context.scene.collection).objects.link(made)


def choose(
    context: bpy.types.Context, chosen: list[bpy.types.Object], active: bpy.types.Object
) -> None:
    """Select these objects and no others."""
    for other in list(context.view_layer.objects.selected):
        other.select_set(False)
    for each in chosen:
        each.select_set(True)
    context.view_layer.objects.active = active


@contextmanager
def all_or_nothing(context: bpy.types.Context) -> Iterator[None]:
    """Remove what was made inside if it ends with an error."""
    before = {kind: {each.session_uid for each in getattr(bpy.data, kind)} for kind in KINDS}
    try:
        yield
    except BaseException:
        in_object_mode(context)
        for kind in KINDS:
            data = getattr(bpy.data, kind)
            bpy.data.batch_remove([x for x in data if x.session_uid not in before[kind]])
        raise
