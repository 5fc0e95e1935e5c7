"""Button: variants as strips of the NLA."""

from typing import ClassVar

import bpy

from ..mocap_assist.variants.crowd import stack, why_not_stack
from ..solvers.errors import MocapAssistError


class MOCAP_OT_stack_variants(bpy.types.Operator):
    bl_idname = "mocap_assist.stack_variants"
    bl_label = "Push to NLA"
    bl_description = "Put the picked variants, or all, on NLA tracks, one after the other"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if reason := why_not_stack(context):
            cls.poll_message_set(reason)
        return not reason

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            self.report({"INFO"}, stack(context))
        except MocapAssistError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}
