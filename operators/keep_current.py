"""Button: index a library by itself when its sources change, or no longer."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.act_operator import ActOperator
from ..mocap_assist.library.auto_update_list import toggle_kept


class MOCAP_OT_keep_current(ActOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.keep_current"
    bl_label = "Auto-Update"
    bl_description = (
        "Update this library in the background when its sources change; press again to stop"
    )
    bl_options: ClassVar = set[str]()  # nothing of the file is changed

    def act(self, context: bpy.types.Context) -> str:
        return toggle_kept(context.scene.mocap_assist.library.settings().choices)
