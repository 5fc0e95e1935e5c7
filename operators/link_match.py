"""Button: link the action that is chosen in the list, or append it as it is."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.act_operator import ActOperator
from ..mocap_assist.find_similar.linking import take_chosen, why_not_link


class MOCAP_OT_link_match(ActOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.link_match"
    bl_label = "Link Action"
    bl_description = (
        "Link the action from its .blend file and assign it where the armature has its bones"
    )
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    why_not = why_not_link

    link: bpy.props.BoolProperty(
        name="Link",
        description="Keep the action in its own file instead of copying it into this one",
        default=True,
        options={"SKIP_SAVE"},
    )

    def act(self, context: bpy.types.Context) -> str:
        return take_chosen(context, self.link)
