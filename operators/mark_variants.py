"""Button: variants as assets."""

from typing import ClassVar

import bpy

from ..mocap_assist.variants.listing import why_none
from ..mocap_assist.variants.marking import mark_variants
from ..solvers.errors import MocapAssistError


class MOCAP_OT_mark_variants(bpy.types.Operator):
    bl_idname = "mocap_assist.mark_variants"
    bl_label = "Mark Variants as Assets"
    bl_description = (
        "Let the picked variants, or all, be assets, with tags, a catalog and their pictures"
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
        if reason := why_none(context):
            cls.poll_message_set(reason)
        return not reason

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            self.report({"INFO"}, mark_variants(context.scene, self.tags, self.catalog))
        except MocapAssistError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        return context.window_manager.invoke_props_dialog(self)
