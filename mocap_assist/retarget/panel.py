"""Panel: transfer the motion to another armature, and reduce keys."""

from typing import ClassVar

import bpy

from ...solvers.errors import MocapAssistError
from ...solvers.retargeting import RetargetSettings, RootMotion
from ..blender.mixins import PanelMixin
from ..blender.name_lists import SEPARATOR, join_names, split_names
from ..languages import translated
from ..panel_parts.panel_layout import draw_sentence, exists, folded, settings_column
from ..panel_parts.presets import draw_presets
from ..panel_parts.visibility import shows_armature
from ..rigs.rigify import is_rigify
from ..runtime.selection import selected_armature, why_not_read, why_not_retarget
from .bone_list import draw_bones
from .button_settings import Takes
from .retargeting import fitting_actions, remarks_on_target, target_called

RETARGET, UNBAKE, TICK = (
    f"mocap_assist.{name}" for name in ("retarget", "reduce_keys", "tick_action")
)
MAIN = ("root_motion", "keep_feet", "keep_hands")
MAX_LISTED = 30


class RetargetPanel(PanelMixin):
    """Target, motions, settings and the button of Retarget."""

    bl_label = "Retarget"
    bl_options: ClassVar = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return exists(RETARGET) and shows_armature(context)

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
            _draw_actions(column, context)
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
        if exists(UNBAKE):
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


def _draw_actions(column: bpy.types.UILayout, context: bpy.types.Context) -> None:
    ticked = split_names(context.scene.mocap_assist.retarget.actions)
    source = selected_armature(context)
    found = [] if source is None else fitting_actions(source)
    box = column.column(align=True)
    for action, _ in found[:MAX_LISTED]:
        icon = "CHECKBOX_HLT" if action.name in ticked else "CHECKBOX_DEHLT"
        box.operator(TICK, text=action.name, translate=False, icon=icon).action = action.name
    if len(found) > MAX_LISTED:
        column.prop(context.scene.mocap_assist.retarget, "actions")


def _draw_folded(column: bpy.types.UILayout, shown: bpy.types.PropertyGroup) -> None:
    header, body = column.panel("mocap_assist_retarget_advanced", default_closed=True)
    header.label(text="Advanced")
    if body is None:
        return
    on_root = shown.root_motion == RootMotion.ROOT_BONE.name
    for name in folded(RetargetSettings, MAIN, shown):
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


class MOCAP_OT_tick_action(bpy.types.Operator):
    bl_idname = TICK
    bl_label = "Select Action"
    bl_description = "Add this action to the selection, or remove it"
    bl_options: ClassVar = {"INTERNAL", "UNDO"}

    action: bpy.props.StringProperty(
        name="Action", description="Name of the action", options={"SKIP_SAVE"}
    )
    group: bpy.props.StringProperty(default="retarget", options={"HIDDEN", "SKIP_SAVE"})

    def execute(self, context: bpy.types.Context) -> set[str]:
        if SEPARATOR in self.action:
            self.report(
                {"ERROR"},
                translated(f"Rename {self.action}: a name cannot contain {SEPARATOR}."),
            )
            return {"CANCELLED"}
        shown = getattr(context.scene.mocap_assist, self.group)
        names = split_names(shown.actions)
        others = [name for name in names if name != self.action]
        shown.actions = join_names(
            others if len(others) < len(names) else [*names, self.action]
        )
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory((MOCAP_OT_tick_action,))
