"""Panel: take jitter, spikes and gaps out of the action."""

import bpy

from ...solvers.denoising import PART_STRENGTHS, DenoiseSettings, PlantSettings
from ..blender.mixins import PanelMixin
from ..panel_parts.panel_layout import (
    draw_sentence,
    folded_settings,
    operator_exists,
    settings_column,
)
from ..panel_parts.presets import draw_presets
from ..panel_parts.visibility import shows_take
from ..runtime.selection import selected_subject, why_not_clean
from .button_settings import Prior
from .example_list import draw_examples

PARTS = tuple(PART_STRENGTHS.values())
LEARN = "mocap_assist.learn_patterns"
OF_JOINTS = {"joint_limits"}
MAIN = ("strength", "frame_range", "joint_limits", "result_as")


class CleanPanel(PanelMixin):
    """Settings of Clean, and its button."""

    bl_label = "Clean"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return shows_take(context)

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        draw_presets(self.layout, "clean")

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        column = settings_column(layout, context, "clean")
        clean = context.scene.mocap_assist.clean
        subject = selected_subject(context)
        joints = subject is None or subject.type == "ARMATURE"
        _draw_main(column, clean, joints)
        if joints:
            _draw_parts(column, clean)
        _draw_folded(column, clean, joints)
        button = layout.row()
        button.scale_y = 1.6
        button.operator("mocap_assist.denoise", icon="BRUSH_DATA")
        if reason := why_not_clean(context):
            draw_sentence(layout, context, reason, icon="INFO")


def _draw_main(
    column: bpy.types.UILayout, clean: bpy.types.PropertyGroup, joints: bool
) -> None:
    """Draw what everybody needs; markers have neither joint limits nor feet."""
    column.row().prop(clean, "bones", text="Bones" if joints else "Markers", expand=True)
    column.prop(clean, "prior")
    if clean.prior == Prior.EXAMPLES.name:
        draw_examples(column, clean)
    if clean.prior in {Prior.EXAMPLES.name, Prior.LEARNED.name}:
        _draw_learned(column, clean)
    for name in MAIN:
        if joints or name not in OF_JOINTS:
            row = column.row()
            row.use_property_decorate = name == "strength"  # it can have keys
            row.prop(clean, name)
    column.prop(clean, "plant_feet" if joints else "unswap")


def _draw_parts(column: bpy.types.UILayout, clean: bpy.types.PropertyGroup) -> None:
    """Draw the strength of each part of the body, with dots for keys."""
    header, body = column.panel("mocap_assist_clean_parts", default_closed=True)
    header.label(text="Body Parts")
    if body is None:
        return
    for name in PARTS:
        row = body.row()
        row.use_property_decorate = True
        row.prop(clean, name, slider=True)
    body.prop(clean, "keyed_strength")


def _draw_learned(column: bpy.types.UILayout, clean: bpy.types.PropertyGroup) -> None:
    """Draw the file that patterns are learned from, or that Learn can keep them in."""
    if clean.prior == Prior.LEARNED.name:
        column.prop(clean, "learned_file")
    elif clean.examples and operator_exists(LEARN):
        column.prop(clean, "learned_file", text="Save As")
        column.operator(LEARN, text="Learn and Save", icon="FILE_TICK")


def _draw_folded(
    column: bpy.types.UILayout, clean: bpy.types.PropertyGroup, joints: bool
) -> None:
    header, body = column.panel("mocap_assist_clean_advanced", default_closed=True)
    header.label(text="Advanced")
    if body is None:
        return
    for name in folded_settings(DenoiseSettings, (*MAIN, *PARTS), clean):
        body.prop(clean, name)
    if not joints:
        return
    feet = body.column()
    feet.active = clean.plant_feet
    for name in folded_settings(PlantSettings, MAIN, clean):
        feet.prop(clean, name)
