"""Panel: from the markers of an optical take to a skeleton."""

from dataclasses import fields
from typing import ClassVar

import bpy

from ...solvers.markers import SolveSettings
from ...solvers.workflows import MarkerMotionSettings
from ..blender.mixins import PanelMixin
from ..panel_parts.panel_layout import draw_sentence, operator_exists, settings_column
from ..panel_parts.visibility import shows_all
from ..runtime.selection import selected_subject
from .scene_skeleton import why_not_solve

SOLVE_OPERATOR = "mocap_assist.solve_skeleton"


class MarkersPanel(PanelMixin):
    """Settings of Make Skeleton, and its button."""

    bl_label = "Markers"
    bl_options: ClassVar = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        subject = selected_subject(context)
        is_marked = subject is not None and subject.type != "ARMATURE"
        return operator_exists(SOLVE_OPERATOR) and (is_marked or shows_all(context))

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        column = settings_column(layout, context, "solve")
        solve = context.scene.mocap_assist.solve
        for item in (*fields(MarkerMotionSettings), *fields(SolveSettings)):
            if not item.metadata["described"].advanced:
                column.prop(solve, item.name)
        layout.operator(SOLVE_OPERATOR, icon="ARMATURE_DATA")
        if reason := why_not_solve(context):
            draw_sentence(layout, context, reason, icon="INFO")
