"""Button: of many variants keep the best."""

from typing import ClassVar

import bpy

from ..mocap_assist.variants.listing import keep_picked, why_not_keep


class MOCAP_OT_keep_variants(bpy.types.Operator):
    bl_idname = "mocap_assist.keep_variants"
    bl_label = "Keep Picked"
    bl_description = "Delete the listed variants that are neither picked nor used elsewhere"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if reason := why_not_keep(context):
            cls.poll_message_set(reason)
        return not reason

    def execute(self, context: bpy.types.Context) -> set[str]:
        self.report({"INFO"}, keep_picked(context.scene))
        return {"FINISHED"}
