"""Button: give what was imported another up axis, forward axis or scale."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.act_operator import ActOperator
from ..mocap_assist.blender.mixins import SettingsMixin
from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.importing.changing_axes import (
    AxesBundle,
    change_axes,
    imported_object,
    noted_change,
    why_fixed,
)
from ..mocap_assist.importing.dialog.operators import DIALOG_WIDTH_PX
from ..mocap_assist.importing.show_actor import follow_actor, positions_of_views
from ..solvers.errors import InvalidMotionError


@settings_from(AxesBundle)
class MOCAP_OT_change_axes(SettingsMixin, ActOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.change_axes"
    bl_label = "Change Axes and Scale"
    bl_description = "Rotate or scale the imported take if its axes or unit are wrong"
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    why_not = why_fixed

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self.set_properties(noted_change(imported_object(context)))
        self._positions = positions_of_views(context)  # again for each change in the redo panel
        status: set[str] = context.window_manager.invoke_props_dialog(
            self, width=DIALOG_WIDTH_PX, confirm_text="Change"
        )
        return status

    def act(self, context: bpy.types.Context) -> str:
        owner = imported_object(context)
        if owner is None:
            raise InvalidMotionError(why_fixed(context))
        before = owner.matrix_world.copy()
        message = change_axes(context, owner, self.settings().change)
        if hasattr(self, "_positions"):
            change = owner.matrix_world @ before.inverted_safe()
            follow_actor(context, self._positions, change)
        return message

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        for name in type(self).setting_names:
            self.layout.prop(self, name)
