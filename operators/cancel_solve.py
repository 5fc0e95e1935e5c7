"""Button in the status bar: cancel the running solve, as Esc does."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.act_operator import ActOperator
from ..mocap_assist.runtime.watch import CANCEL, cancel_running, why_not_cancel


class MOCAP_OT_cancel_solve(ActOperator, bpy.types.Operator):
    bl_idname = CANCEL
    bl_label = "Cancel"
    bl_description = "Stop this solve; the scene stays as it is"
    bl_options: ClassVar = {"INTERNAL"}
    why_not = why_not_cancel

    def execute(self, context: bpy.types.Context) -> set[str]:
        cancel_running()
        return {"FINISHED"}
