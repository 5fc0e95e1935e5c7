"""Button: variants as assets."""

from typing import ClassVar

import bpy

from ..mocap_assist.find_similar.mark_operator import MarkOperator
from ..mocap_assist.variants.listing import why_none
from ..mocap_assist.variants.marking import mark_variants


class MOCAP_OT_mark_variants(MarkOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.mark_variants"
    bl_label = "Mark Variants as Assets"
    bl_description = (
        "Mark the picked variants, or all, as assets with tags, a catalog and previews"
    )
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    why_not = why_none

    def act(self, context: bpy.types.Context) -> str:
        return mark_variants(context.scene, self.tags, self.catalog)
