"""Button: choose a folder whose takes are imported and fixed one after another."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.path_properties import ChoosesFolder
from ..mocap_assist.runtime.watch import why_busy


class MOCAP_OT_fix_folder(ChoosesFolder, bpy.types.Operator):
    bl_idname = "mocap_assist.fix_folder"
    bl_label = "Fix Folder"
    bl_description = "Import each recording of a folder and fix it; Esc keeps what is done"
    bl_options: ClassVar = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if reason := why_busy():
            cls.poll_message_set(reason)
        return not reason

    def execute(self, context: bpy.types.Context) -> set[str]:
        # Blender frees an operator that the file browser has executed, so another one waits.
        try:
            status: set[str] = bpy.ops.mocap_assist.fix_takes(
                "INVOKE_DEFAULT", directory=self.directory
            )
        except RuntimeError as error:  # its own sentence, such as that the folder is empty
            self.report({"ERROR"}, str(error).removeprefix("Error: ").strip())
            return {"CANCELLED"}
        return status & {"CANCELLED"} or {"FINISHED"}
