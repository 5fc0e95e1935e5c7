"""Button: let the action be an asset."""

from typing import ClassVar

import bpy

from ..mocap_assist.find_similar.mark_operator import MarkOperator
from ..mocap_assist.find_similar.marking import mark_played, why_not_mark
from ..mocap_assist.runtime.selection import played_source, selected_armature


class MOCAP_OT_mark_asset(MarkOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.mark_asset"
    bl_label = "Mark as Asset"
    bl_description = (
        "Mark the played result or action as an asset with tags, a catalog and a preview"
    )
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    why_not = why_not_mark

    def draw(self, context: bpy.types.Context) -> None:
        """Name the action: the list above the button shows others."""
        action, _ = played_source(selected_armature(context))
        self.layout.label(text=action.name, icon="ACTION", translate=False)
        for name in ("tags", "catalog"):
            self.layout.prop(self, name)

    def act(self, context: bpy.types.Context) -> str:
        return mark_played(context, self.tags, self.catalog)
