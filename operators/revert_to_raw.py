"""Button: play the recorded action again."""

import bpy

from ..mocap_assist.check.reverting import revert, why_not_revert
from ..mocap_assist.runtime.selection import selected_subject


class MOCAP_OT_revert_to_raw(bpy.types.Operator):
    bl_idname = "mocap_assist.revert_to_raw"
    bl_label = "Revert to Raw"
    bl_description = "Assign the recorded action again; the cleaned one stays in the file"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if reason := why_not_revert(context):
            cls.poll_message_set(reason)
        return not reason

    def execute(self, context: bpy.types.Context) -> set[str]:
        self.report({"INFO"}, revert(selected_subject(context)))
        return {"FINISHED"}
