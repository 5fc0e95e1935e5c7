"""Panel: reconstruct missing joints of a depth camera, and show their reliability."""

from typing import ClassVar

import bpy

from ...solvers.denoising import PlantSettings
from ...solvers.reconstruction import ReconstructSettings
from ..blender.mixins import PanelMixin
from ..clean.example_list import RECONSTRUCT, draw_examples
from ..overlays.confidence_switch import draw_confidence_switch
from ..panel_parts.panel_layout import (
    draw_sentence,
    folded_settings,
    operator_exists,
    settings_column,
)
from ..panel_parts.presets import draw_presets
from ..panel_parts.visibility import shows_all
from ..runtime.selection import selected_armature
from ..scene.origin import origin_of, was_tracked
from .button_settings import Postures
from .scene_reconstructing import why_not_reconstruct

BUTTON = "mocap_assist.reconstruct"


class ReconstructPanel(PanelMixin):
    """Settings of Reconstruct, its button, and the switch of the confidence colors."""

    bl_label = "Reconstruct"
    bl_options: ClassVar = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return operator_exists(BUTTON) and (
            shows_all(context) or _is_suitable(selected_armature(context))
        )

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        draw_presets(self.layout, "reconstruct")

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        column = settings_column(layout, context, "reconstruct")
        settings = context.scene.mocap_assist.reconstruct
        column.prop(settings, "postures", text="Poses")
        if settings.postures == Postures.EXAMPLES.name:
            draw_examples(column, settings, RECONSTRUCT)
        elif settings.postures == Postures.LEARNED.name:
            column.prop(settings, "postures_file")
        for name in ("frame_range", "result_as", "plant_feet"):
            column.prop(settings, name)
        _draw_folded(column, settings)
        button = layout.row()
        button.scale_y = 1.6
        button.operator(BUTTON, icon="OUTLINER_OB_ARMATURE")
        if reason := why_not_reconstruct(context):
            draw_sentence(layout, context, reason, icon="INFO")
        draw_confidence_switch(layout, context)


def _is_suitable(armature: bpy.types.Object | None) -> bool:
    """Whether an armature was imported from joints of a camera, or not by Mocap Assist."""
    if armature is None:
        return False
    return was_tracked(armature) or not origin_of(armature)


def _draw_folded(column: bpy.types.UILayout, settings: bpy.types.PropertyGroup) -> None:
    header, body = column.panel("mocap_assist_reconstruct_advanced", default_closed=True)
    header.label(text="Advanced")
    if body is None:
        return
    for name in ("residuals_file", *folded_settings(ReconstructSettings, (), settings)):
        body.prop(settings, name)
    feet = body.column()
    feet.active = settings.plant_feet
    for name in folded_settings(PlantSettings, (), settings):
        feet.prop(settings, name)
