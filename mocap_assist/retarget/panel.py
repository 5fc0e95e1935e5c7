"""Panel: transfer the motion to another armature, and reduce keys."""

from typing import ClassVar

import bpy

from ...solvers.errors import MocapAssistError
from ...solvers.retargeting import RetargetSettings, RootMotion
from ..blender.mixins import PanelMixin
from ..panel_parts.panel_layout import (
    draw_sentence,
    folded_settings,
    operator_exists,
    settings_column,
)
from ..panel_parts.presets import draw_presets
from ..panel_parts.visibility import shows_armature
from ..rigs.rigify import is_rigify
from ..runtime.selection import selected_armature, why_not_read, why_not_retarget
from .action_ticks import draw_ticks
from .bone_list import draw_bones
from .button_settings import Takes
from .scene_retargeting import fitting_actions, remarks_on_target, target_called

RETARGET, UNBAKE = "mocap_assist.retarget", "mocap_assist.reduce_keys"
MAIN = ("root_motion", "keep_feet", "keep_hands")


class RetargetPanel(PanelMixin):
    """Target, motions, settings and the button of Retarget."""

    bl_label = "Retarget"
    bl_options: ClassVar = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return operator_exists(RETARGET) and shows_armature(context)

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        draw_presets(self.layout, "retarget")

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        shown = context.scene.mocap_assist.retarget
        reason = why_not_pressed(context)
        column = settings_column(layout, context, "retarget", "unbake")
        column.prop_search(shown, "target", context.scene, "objects", icon="ARMATURE_DATA")
        column.prop(shown, "takes")
        if shown.takes == Takes.LISTED.name:
            source = selected_armature(context)
            fitting = () if source is None else fitting_actions(source)
            draw_ticks(column, context, [action for action, _ in fitting], "retarget")
        for name in MAIN:
            column.prop(shown, name)
        target = context.scene.objects.get(shown.target)
        if target is not None and target.type == "ARMATURE" and is_rigify(target.data.bones):
            column.prop(shown, "limbs")
        _draw_folded(column, shown)
        _draw_bones(layout, context)
        button = layout.row()
        button.scale_y = 1.6
        button.enabled = not reason
        button.operator(RETARGET, icon="CON_ARMATURE")
        if reason:
            draw_sentence(layout, context, reason, icon="INFO")
        elif (source := selected_armature(context)) is not None:
            for remark in remarks_on_target(source, context.scene.objects[shown.target]):
                draw_sentence(layout, context, f"{remark}.", icon="ERROR")
        if operator_exists(UNBAKE):
            _draw_unbake(layout, context)


def why_not_pressed(context: bpy.types.Context) -> str:
    """Return why Retarget has no effect with the shown settings, or an empty text."""
    if reason := why_not_retarget(context):
        return reason
    shown = context.scene.mocap_assist.retarget
    if shown.takes == Takes.PLAYED.name and (reason := why_not_read(context)):
        return reason
    try:
        target_called(context.scene, shown.target, selected_armature(context))
    except MocapAssistError as error:
        return str(error)
    return ""


def _draw_folded(column: bpy.types.UILayout, shown: bpy.types.PropertyGroup) -> None:
    header, body = column.panel("mocap_assist_retarget_advanced", default_closed=True)
    header.label(text="Advanced")
    if body is None:
        return
    on_root = shown.root_motion == RootMotion.ROOT_BONE.name
    for name in folded_settings(RetargetSettings, MAIN, shown):
        row = body.row()
        row.active = on_root or name != "turn_root"
        row.prop(shown, name)
    body.prop(shown, "source_map_file")
    body.prop(shown, "target_map_file")


def _draw_bones(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    header, body = layout.panel("mocap_assist_retarget_bones", default_closed=False)
    header.label(text="Bones")
    if body is not None:
        draw_bones(body, context)


def _draw_unbake(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    column = layout.column(align=True)
    column.separator()
    column.label(text="Reduce Keys")
    column.prop(context.scene.mocap_assist.unbake, "tolerance")
    column.prop(context.scene.mocap_assist.unbake, "key_poses")
    column.operator(UNBAKE, icon="KEYFRAME")
