"""Show a dialed influence of a delta at once.

Blender evaluates an edited strip only at the next frame. An influence with keys is left to
Blender: evaluated again, it would have the value of its keys before it can be keyed.
"""

import bpy
from bpy.app import handlers

from ..actions.delta_layer import delta_strip

_owner = object()
"""What Blender knows the subscription by."""


def show_influence() -> None:
    """Evaluate all armatures of the scene whose delta has an influence without keys."""
    for armature in bpy.context.scene.objects:
        strip = delta_strip(armature) if armature.type == "ARMATURE" else None
        if strip and not any(len(curve.keyframe_points) for curve in strip.fcurves):
            armature.update_tag(refresh={"TIME"})


@handlers.persistent
def _subscribe(*_: object) -> None:
    """Subscribe to edits of influences; Blender forgets it whenever it loads a file."""
    bpy.msgbus.clear_by_owner(_owner)
    bpy.msgbus.subscribe_rna(
        key=(bpy.types.NlaStrip, "influence"), owner=_owner, args=(), notify=show_influence
    )


def register() -> None:
    """Subscribe now and after each file."""
    _subscribe()
    handlers.load_post.append(_subscribe)


def unregister() -> None:
    """End the subscription."""
    handlers.load_post.remove(_subscribe)
    bpy.msgbus.clear_by_owner(_owner)
