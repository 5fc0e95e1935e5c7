"""Button: of many variants keep the best."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.act_operator import ActOperator
from ..mocap_assist.variants.listing import keep_picked, why_not_keep


class MOCAP_OT_keep_variants(ActOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.keep_variants"
    bl_label = "Keep Picked"
    bl_description = "Delete the listed variants that are neither picked nor used elsewhere"
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    why_not = why_not_keep

    def act(self, context: bpy.types.Context) -> str:
        return keep_picked(context.scene)
