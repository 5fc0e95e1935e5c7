"""Button: give what was imported another up axis, forward axis or scale."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.mixins import SettingsMixin
from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.importing.changing_axes import (
    AxesSettings,
    change_axes,
    imported_object,
    noted_change,
    why_fixed,
)
from ..mocap_assist.importing.import_operator import WIDTH
from ..solvers.errors import MocapAssistError


@settings_from(AxesSettings)
class MOCAP_OT_change_axes(SettingsMixin, bpy.types.Operator):
    bl_idname = "mocap_assist.change_axes"
    bl_label = "Change Up Axis, Forward, Scale"
    bl_description = "Turn or scale the imported take if its file was read wrong"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        reason = why_fixed(context)
        if reason:
            cls.poll_message_set(reason)
        return not reason

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self.set_properties(noted_change(imported_object(context)))
        asked: set[str] = context.window_manager.invoke_props_dialog(
            self, width=WIDTH, confirm_text="Change"
        )
        return asked

    def execute(self, context: bpy.types.Context) -> set[str]:
        owner = imported_object(context)
        if owner is None:
            return {"CANCELLED"}
        try:
            message = change_axes(context, owner, self.settings().change)
        except MocapAssistError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, message)
        return {"FINISHED"}

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        for name in type(self).setting_names:
            self.layout.prop(self, name)
