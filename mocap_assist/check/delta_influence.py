"""Show a dialed influence of a delta at once.

Blender evaluates an edited strip only at the next frame. An influence with keys is left to
Blender: evaluated again, it would have the value of its keys before it can be keyed.
"""

import bpy

from ..actions.delta_layer import delta_strip
from ..blender.subscriptions import subscription


def show_influence() -> None:
    """Evaluate all armatures of the scene whose delta has an influence without keys."""
    for armature in bpy.context.scene.objects:
        strip = delta_strip(armature) if armature.type == "ARMATURE" else None
        if strip and not any(len(curve.keyframe_points) for curve in strip.fcurves):
            armature.update_tag(refresh={"TIME"})


register, unregister = subscription((bpy.types.NlaStrip, "influence"), show_influence)
