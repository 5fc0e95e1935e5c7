"""Button: let the action be an asset."""

from typing import ClassVar

import bpy

from ..mocap_assist.library.marking import mark_played, why_not_mark
from ..solvers.errors import MocapAssistError


class MOCAP_OT_mark_asset(bpy.types.Operator):
    bl_idname = "mocap_assist.mark_asset"
    bl_label = "Mark as Asset"
    bl_description = (
        "Let the action that the armature plays be an asset, with tags, a catalog and a picture"
        " of what it does"
    )
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    tags: bpy.props.StringProperty(
        name="Tags", description="Separated by commas", options={"SKIP_SAVE"}
    )
    catalog: bpy.props.StringProperty(
        name="Catalog",
        description="Path of the catalog, such as Locomotion/Walks; empty for none",
        options={"SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if reason := why_not_mark(context):
            cls.poll_message_set(reason)
        return not reason

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            self.report({"INFO"}, mark_played(context, self.tags, self.catalog))
        except MocapAssistError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        return context.window_manager.invoke_props_dialog(self)
