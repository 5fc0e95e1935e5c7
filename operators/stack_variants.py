"""Button: variants as strips of the NLA."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.act_operator import ActOperator
from ..mocap_assist.variants.crowd import put_on_tracks, why_not_stack


class MOCAP_OT_stack_variants(ActOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.stack_variants"
    bl_label = "Push to NLA"
    bl_description = "Put the picked variants, or all, on NLA tracks, one after the other"
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    why_not = why_not_stack

    def act(self, context: bpy.types.Context) -> str:
        return put_on_tracks(context)
