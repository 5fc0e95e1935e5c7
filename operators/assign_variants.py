"""Button: a crowd plays the variants."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.act_operator import ActOperator
from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.variants.button_settings import CrowdBundle
from ..mocap_assist.variants.crowd import assign, crowd_of, why_not_assign


@settings_from(CrowdBundle)
class MOCAP_OT_assign_variants(ActOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.assign_variants"
    bl_label = "Assign to Selected"
    bl_description = (
        "Play a different variant on each selected armature, at a random start and position"
    )
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    why_not = why_not_assign

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        for name in type(self).setting_names:
            if not self.properties.is_property_set(name):
                setattr(self, name, getattr(context.scene.mocap_assist.crowd, name))
        return self.execute(context)

    def act(self, context: bpy.types.Context) -> str:
        return assign(context, crowd_of(context), self.settings())
