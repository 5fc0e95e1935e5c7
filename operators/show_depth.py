"""Button: show the depth recording of another user's file."""

from typing import ClassVar

import bpy

from ..mocap_assist.depth.depth_preview import show_on_request
from ..mocap_assist.languages import translated
from ..mocap_assist.track.tracking import selected_preview
from ..solvers.errors import MocapAssistError


class MOCAP_OT_show_depth(bpy.types.Operator):
    bl_idname = "mocap_assist.show_depth"
    bl_label = "Show Points"
    bl_description = (
        "Open the depth recording of this object, now and whenever the file is loaded"
    )
    bl_options: ClassVar = set[str]()

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if selected_preview(context) is None:
            cls.poll_message_set(translated("Select the points of a depth recording."))
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        preview = selected_preview(context)
        if preview is None:
            return {"CANCELLED"}
        try:
            message = show_on_request(preview.data, context.scene.frame_current_final)
        except MocapAssistError as error:
            self.report({"ERROR"}, translated(str(error)))
            return {"CANCELLED"}
        self.report({"INFO"}, translated(message))
        return {"FINISHED"}
