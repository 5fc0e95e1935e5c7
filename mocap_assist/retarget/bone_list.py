"""Editable list of bones by humanoid role, and its presets."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import ClassVar

import bpy

from ...solvers.errors import InvalidMotionError, MocapAssistError
from ...solvers.motion import read_humanoid_map, write_humanoid_map
from ..blender.last_press import note_press, noted_errors
from ..blender.mixins import OperatorMixin
from ..blender.path_properties import absolute, path_property
from ..languages import translated
from ..overlays.color_icons import BARS, bars_icon, square_icon
from ..overlays.marked_ranges import MARKS, Mark, StripRow, confidence_mark
from ..panel_parts.panel_layout import draw_sentence, is_wide
from ..runtime.selection import selected_armature, why_not_retarget
from .bone_highlight import COLOR, SWITCH, why_certain
from .bone_map import (
    LISTED_ARMATURES,
    BoneMaps,
    count_low_confidence,
    find_maps,
    has_low_confidence,
    list_maps,
    listed_armature,
    listed_maps,
)
from .rest_preview import draw_rest_switch
from .role_labels import role_label
from .scene_retargeting import target_called

FIND, SAVE, LOAD = (
    f"mocap_assist.{name}" for name in ("find_bones", "save_bone_map", "load_bone_map")
)
ROLE_COLUMN = 0.36  # of a wide list
PRESETS = {
    (SAVE, "source"): "Save Source Map",
    (SAVE, "target"): "Save Target Map",
    (LOAD, "source"): "Load Source Map",
    (LOAD, "target"): "Load Target Map",
}
PACKAGE = __package__.rpartition(".mocap_assist.")[0]


class MOCAP_UL_bones(bpy.types.UIList):
    """A row for each part of the body: the bone of the source, and that of the target."""

    def draw_item(
        self,
        context: bpy.types.Context,
        layout: bpy.types.UILayout,
        listed: bpy.types.PropertyGroup,
        row: bpy.types.PropertyGroup,
        icon: int,
        active_data: bpy.types.PropertyGroup,
        active_property: str,
        index: int,
    ) -> None:
        """Draw the role and both bones: missing ones in red, others with confidence bars.

        A narrow list has bars for the less certain bone alone, and the role only in place of a
        source bone that is missing: names would be cut. They are drawn without the namespace,
        such as mixamorig:.
        """
        bars = {side: _bars(row, side) for side in LISTED_ARMATURES}
        wide, known = is_wide(context), [each for each in bars.values() if each]
        lowest = min(known, key=BARS.__getitem__, default=None)
        role = role_label(row.name)
        columns = _columns(layout, role, wide=wide)
        for side, mark in bars.items():
            armature, bone = listed_armature(listed, side), getattr(row, side)
            cell = columns.row()
            cell.active = bool(bone)
            cell.alert = bool(bone) and armature is not None and bone not in armature.data.bones
            is_first = side == LISTED_ARMATURES[0]
            missing = role if is_first and not wide else "-"
            shown = mark if wide else lowest if is_first else None
            _draw_cell(cell, bone.rpartition(":")[2] or missing, shown)


def _columns(layout: bpy.types.UILayout, first: str, *, wide: bool) -> bpy.types.UILayout:
    """Return the columns of source and target, in a wide list to the right of a first text."""
    if not wide:
        return layout.split(factor=0.5, align=True)
    columns = layout.split(factor=ROLE_COLUMN, align=True)
    columns.label(text=first, translate=False)
    return columns.split(factor=0.5, align=True)


def _bars(row: bpy.types.PropertyGroup, side: str) -> Mark | None:
    """Return the level of confidence in a bone of a row; None where there is no bone."""
    confidence: float = getattr(row, f"{side}_confidence")
    return confidence_mark(confidence) if getattr(row, side) else None


def _draw_cell(layout: bpy.types.UILayout, text: str, mark: Mark | None) -> None:
    layout.label(text=text, icon_value=0 if mark is None else bars_icon(mark), translate=False)


class _BoneButton(OperatorMixin):
    """A button that fills the list."""

    bl_options: ClassVar = {"INTERNAL", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        reason = why_not_retarget(context)
        if not reason and not context.scene.mocap_assist.retarget.target:
            reason = "Choose the target armature first."
        if reason:
            cls.poll_message_set(translated(reason))
        return not reason

    def done(self, act: Callable[[], None]) -> set[str]:
        """Run an action, and report an error as a sentence."""
        try:
            with noted_errors(self):
                act()
        except MocapAssistError as error:
            self.report({"ERROR"}, translated(str(error)))
            return {"CANCELLED"}
        note_press(self)
        return {"FINISHED"}


def _both_armatures(
    context: bpy.types.Context,
) -> tuple[bpy.types.Object, bpy.types.Object]:
    """Return the source and the target; raise InvalidMotionError where one is missing."""
    source = selected_armature(context)
    if source is None:
        raise InvalidMotionError("Select an animated armature.")
    name = context.scene.mocap_assist.retarget.target
    return source, target_called(context.scene, name, source)


class MOCAP_OT_find_bones(_BoneButton, bpy.types.Operator):
    bl_idname = FIND
    bl_label = "Find Bones"
    bl_description = "Match the bones of both armatures by their names and rest poses"

    def execute(self, context: bpy.types.Context) -> set[str]:
        return self.done(partial(self.find, context))

    def find(self, context: bpy.types.Context) -> None:
        """Fill the list again."""
        found = context.scene.mocap_assist
        source, target = _both_armatures(context)
        list_maps(found.bone_map, source, target, find_maps(source, target))


class _PresetButton(_BoneButton):
    """A button for a file of one armature's bones."""

    filepath: path_property(options={"SKIP_SAVE"})
    filter_glob: bpy.props.StringProperty(default="*.json", options={"HIDDEN", "SKIP_SAVE"})
    side: bpy.props.EnumProperty(
        name="Armature",
        description="Armature of the bone map",
        items=[
            (side, side.capitalize(), f"Bone map of the {side} armature")
            for side in LISTED_ARMATURES
        ],
        options={"SKIP_SAVE"},
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        name = getattr(context.scene.mocap_assist.bone_map, self.side) or self.side
        self.filepath = str(preset_folder() / f"{bpy.path.clean_name(name)}.json")
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}


class MOCAP_OT_save_bone_map(_PresetButton, bpy.types.Operator):
    bl_idname = SAVE
    bl_label = "Save Bone Map"
    bl_description = "Save the bone map of one armature as a preset"

    def execute(self, context: bpy.types.Context) -> set[str]:
        return self.done(partial(self.save, context))

    def save(self, context: bpy.types.Context) -> None:
        """Write the file atomically."""
        maps = listed_maps(context.scene.mocap_assist.bone_map)
        write_humanoid_map(getattr(maps, self.side), absolute(self.filepath))


class MOCAP_OT_load_bone_map(_PresetButton, bpy.types.Operator):
    bl_idname = LOAD
    bl_label = "Load Bone Map"
    bl_description = "Load the bone map of one armature from a preset"

    def execute(self, context: bpy.types.Context) -> set[str]:
        return self.done(partial(self.load, context))

    def load(self, context: bpy.types.Context) -> None:
        """Put the preset into the list, which is filled first if it was of other armatures."""
        found = context.scene.mocap_assist
        source, target = _both_armatures(context)
        loaded = read_humanoid_map(absolute(self.filepath))
        listed = found.bone_map
        same = (listed.source, listed.target) == (source.name, target.name)
        maps = listed_maps(listed) if same else find_maps(source, target)
        list_maps(listed, source, target, BoneMaps(**maps._asdict() | {self.side: loaded}))


def preset_folder() -> Path:
    """Return the folder of presets, which is the user's and outlives the extension."""
    return Path(bpy.utils.extension_path_user(PACKAGE, path="bone_maps", create=True))


def draw_bones(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the list, its confidence, and its buttons."""
    listed = context.scene.mocap_assist.bone_map
    layout.operator(FIND, icon="VIEWZOOM")
    if not len(listed.rows):
        return
    heads = _columns(layout, translated("Body Parts"), wide=is_wide(context))
    for side in LISTED_ARMATURES:
        heads.label(text=side.capitalize())
    layout.template_list("MOCAP_UL_bones", "", listed, "rows", listed, "active_row", rows=8)
    _draw_legend(layout, context)
    draw_rest_switch(layout, context)
    row = listed.rows[min(listed.active_row, len(listed.rows) - 1)]
    if n_marked := count_low_confidence(listed):
        marked = (
            "1 bone has low confidence; click a row."
            if n_marked == 1
            else f"{n_marked} bones have low confidence; click a row."
        )
        draw_sentence(layout, context, marked, icon="ERROR")
    _draw_reasons(layout, context, row)
    column = layout.column(align=True)
    column.label(text=role_label(row.name), translate=False)
    for side in LISTED_ARMATURES:
        if (armature := listed_armature(listed, side)) is not None:
            column.prop_search(
                row, side, armature.data, "bones", text=side.capitalize(), icon="BONE_DATA"
            )
    for idname, icon in ((SAVE, "FILE_TICK"), (LOAD, "FILE_FOLDER")):
        row = layout.row(align=True)
        for side in LISTED_ARMATURES:
            row.operator(idname, text=PRESETS[idname, side], icon=icon).side = side


def _draw_legend(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the legend of the bars, and the switch of the highlight."""
    row = layout.row(align=True)
    for mark in MARKS[StripRow.CONFIDENCE]:
        row.label(text=mark.value, icon_value=bars_icon(mark))
    color = square_icon(COLOR)
    row.prop(context.window_manager, SWITCH, text="", icon_value=color, toggle=True)


def _draw_reasons(
    layout: bpy.types.UILayout, context: bpy.types.Context, row: bpy.types.PropertyGroup
) -> None:
    """Draw the confidence in both bones of a row, and the reasons."""
    for side in LISTED_ARMATURES:
        if text := why_certain(row, side):
            icon = "ERROR" if has_low_confidence(row, side) else "CHECKMARK"
            draw_sentence(layout, context, text, icon=icon)


register, unregister = bpy.utils.register_classes_factory((
    MOCAP_UL_bones,
    MOCAP_OT_find_bones,
    MOCAP_OT_save_bone_map,
    MOCAP_OT_load_bone_map,
))
