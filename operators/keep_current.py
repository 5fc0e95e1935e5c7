"""Button: index a library by itself when its sources change, or no longer."""

from typing import ClassVar

import bpy

from ..mocap_assist.library.auto_update_list import toggle_kept
from ..solvers.errors import MocapAssistError


class MOCAP_OT_keep_current(bpy.types.Operator):
    bl_idname = "mocap_assist.keep_current"
    bl_label = "Auto-Update"
    bl_description = (
        "Update this library in the background when its sources change; press again to stop"
    )
    bl_options: ClassVar = set[str]()  # nothing of the file is changed

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            message = toggle_kept(context.scene.mocap_assist.library.settings().choices)
        except MocapAssistError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, message)
        return {"FINISHED"}
