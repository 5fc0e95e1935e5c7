"""Panel: let a body with mass and muscles perform the motion."""

from typing import ClassVar

import bpy

from ...solvers.physics import Ground, SimulateSettings
from ..blender.mixins import PanelMixin
from ..panel_parts.panel_layout import (
    draw_sentence,
    folded_settings,
    operator_exists,
    settings_column,
)
from ..panel_parts.presets import draw_presets
from ..panel_parts.visibility import shows_armature
from ..runtime.selection import why_not_change

SIMULATE = "mocap_assist.simulate"
PURPOSE = "Gives the body weight: feet carry it, and it neither floats nor sinks in."


class PhysicsPanel(PanelMixin):
    """Settings of Simulate, and its button."""

    bl_label = "Simulate"
    bl_options: ClassVar = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return operator_exists(SIMULATE) and shows_armature(context)

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        draw_presets(self.layout, "simulate")

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        draw_sentence(layout, context, PURPOSE)
        column = settings_column(layout, context, "simulate")
        _draw_folded(column, context.scene.mocap_assist.simulate)
        button = layout.row()
        button.scale_y = 1.6
        button.operator(SIMULATE, icon="PHYSICS")
        if reason := why_not_change(context):
            draw_sentence(layout, context, reason, icon="INFO")


def _draw_folded(column: bpy.types.UILayout, simulate: bpy.types.PropertyGroup) -> None:
    header, body = column.panel("mocap_assist_simulate_advanced", default_closed=True)
    header.label(text="Advanced")
    if body is None:
        return
    for name in folded_settings(SimulateSettings, (), simulate):
        row = body.row()
        row.active = name != "ground_height" or simulate.ground != Ground.FEET.name
        row.prop(simulate, name)
