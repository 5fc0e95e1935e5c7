"""Button: play the recorded action again."""

import bpy

from ..mocap_assist.blender.act_operator import ActOperator
from ..mocap_assist.check.reverting import revert_to_recorded, why_not_revert
from ..mocap_assist.runtime.after_result import notify_listeners
from ..mocap_assist.runtime.selection import selected_subject


class MOCAP_OT_revert_to_raw(ActOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.revert_to_raw"
    bl_label = "Revert to Raw"
    bl_description = "Assign the recorded action again; the cleaned one stays in the file"
    bl_options = {"REGISTER", "UNDO"}
    why_not = why_not_revert

    def act(self, context: bpy.types.Context) -> str:
        message = revert_to_recorded(selected_subject(context))
        notify_listeners(context.scene)
        return message
