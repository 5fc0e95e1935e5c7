"""Button: link the action that is chosen in the list, or append it as it is."""

from typing import ClassVar

import bpy

from ..mocap_assist.search.linking import take_chosen, why_not_link
from ..solvers.errors import MocapAssistError


class MOCAP_OT_link_match(bpy.types.Operator):
    bl_idname = "mocap_assist.link_match"
    bl_label = "Link Action"
    bl_description = (
        "Link the action from its .blend file and assign it where the armature has its bones"
    )
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    link: bpy.props.BoolProperty(
        name="Link",
        description="Keep the action in its own file instead of copying it into this one",
        default=True,
        options={"SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if reason := why_not_link(context):
            cls.poll_message_set(reason)
        return not reason

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            self.report({"INFO"}, take_chosen(context, self.link))
        except MocapAssistError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}
