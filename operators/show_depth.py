"""Button: show the depth recording of another user's file."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.act_operator import ActOperator
from ..mocap_assist.depth.depth_preview import show_on_request
from ..mocap_assist.track.tracking import why_not_show


class MOCAP_OT_show_depth(ActOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.show_depth"
    bl_label = "Show Points"
    bl_description = (
        "Open the depth recording of this object, now and whenever the file is loaded"
    )
    bl_options: ClassVar = set[str]()
    why_not = why_not_show

    def act(self, context: bpy.types.Context) -> str:
        points = context.view_layer.objects.active
        return show_on_request(points.data, context.scene.frame_current_final)
