"""Button: let the action be an asset."""

from typing import ClassVar

import bpy

from ..mocap_assist.find_similar.mark_operator import MarkOperator
from ..mocap_assist.find_similar.marking import mark_played, why_not_mark


class MOCAP_OT_mark_asset(MarkOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.mark_asset"
    bl_label = "Mark as Asset"
    bl_description = "Mark the current action as an asset with tags, a catalog and a preview"
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    why_not = why_not_mark

    def act(self, context: bpy.types.Context) -> str:
        return mark_played(context, self.tags, self.catalog)
