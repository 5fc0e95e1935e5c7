"""Panel: track the actor in a depth recording."""

from typing import ClassVar

import bpy

from ...solvers.depth_scene import ForegroundMethod
from ...solvers.depth_tracking.capturing import CaptureSettings
from ..blender.mixins import PanelMixin
from ..overlays.color_icons import draw_marks
from ..overlays.marked_ranges import MARKS, StripRow
from ..panel_parts.panel_layout import (
    draw_job,
    draw_sentence,
    folded_settings,
    operator_exists,
    split_column,
)
from ..panel_parts.visibility import shows_all
from .camera_rows import draw_cameras
from .retracking import why_not_retrack
from .tracked_armature.body import is_tracked
from .tracking import selected_preview, why_not_track

TRACK, RETRACK = "mocap_assist.track_depth", "mocap_assist.retrack"
HOW = "Correct the pose at a wrong frame, then press Track from Here."
CUT = ("min_distance", "max_distance")
SHOWN = (
    "all_people", "other_cameras", "backward", "refine", "smoothing", "recorded",
    "plant_feet", "watch", "keep_on_esc",
)  # fmt: skip


class TrackPanel(PanelMixin):
    """Settings of Track, and its button."""

    bl_label = "Track"
    bl_options: ClassVar = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        suits = selected_preview(context) is not None or is_tracked(
            context.view_layer.objects.active
        )
        return operator_exists(TRACK) and (suits or shows_all(context))

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        running = draw_job(layout, context, "track", "retrack")
        active = context.view_layer.objects.active
        draw = _draw_correction if is_tracked(active) else _draw_tracking
        column = layout.column()
        column.enabled = not running
        draw(column, context)


def _draw_tracking(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the settings and button that track an armature."""
    track = context.scene.mocap_assist.track
    column = split_column(layout)
    column.prop(track, "actor_mask")
    if track.actor_mask == ForegroundMethod.CUT.name:
        for name in CUT:
            column.prop(track, name)
    for name in SHOWN:
        column.prop(track, name)
    if "method" in folded_settings(CaptureSettings, (), track):
        column.prop(track, "method")
    if track.other_cameras:
        draw_cameras(layout, context)
    layout.operator(TRACK, icon="OUTLINER_OB_ARMATURE")
    if reason := why_not_track(context):
        draw_sentence(layout, context, reason, icon="INFO")


def _draw_correction(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the controls that show and correct a tracked motion."""
    layout.prop(context.window_manager, "mocap_assist_body", toggle=True, icon="MOD_SKIN")
    if context.window_manager.mocap_assist_body:
        draw_marks(layout, MARKS[StripRow.CONFIDENCE], columns=3)
    column = split_column(layout)
    for name in ("reach", "watch"):
        column.prop(context.scene.mocap_assist.retrack, name)
    layout.operator(RETRACK, icon="TRACKING")
    draw_sentence(layout, context, why_not_retrack(context) or HOW, icon="INFO")
