"""Button: close the card of Fix My Take."""

import bpy

from ..mocap_assist.blender.act_operator import ActOperator
from ..mocap_assist.panel_parts.fix_card import accept, why_not_accept


class MOCAP_OT_accept_fix(ActOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.accept_fix"
    bl_label = "Accept"
    bl_description = "Keep the fixed take and close its report"
    bl_options = {"REGISTER", "UNDO"}
    why_not = why_not_accept

    def act(self, context: bpy.types.Context) -> str:
        return accept(context)
