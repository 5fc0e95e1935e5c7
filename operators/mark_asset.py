"""Button: let the action be an asset."""

from typing import ClassVar

import bpy

from ..mocap_assist.search.mark_operator import MarkOperator
from ..mocap_assist.search.marking import mark_played, why_not_mark


class MOCAP_OT_mark_asset(MarkOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.mark_asset"
    bl_label = "Mark as Asset"
    bl_description = (
        "Let the action that the armature plays be an asset, with tags, a catalog and a picture"
        " of what it does"
    )
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if reason := why_not_mark(context):
            cls.poll_message_set(reason)
        return not reason

    def mark(self, context: bpy.types.Context) -> str:
        return mark_played(context, self.tags, self.catalog)
