"""Panel: track the actor whom a depth camera recorded."""

from typing import ClassVar

import bpy

from ...solvers.motion.depth_foreground import ForegroundWay
from ..scene.tracked_body import is_tracked
from ..tracking import why_not_track
from .drawing import draw_job, draw_sentence, exists

TRACK = "mocap_assist.track_depth"
CUT = ("nearest", "farthest")
SHOWN = ("backward", "refine", "smoothing", "plant_feet", "watch", "keep_on_esc")


class TrackPanel:
    """Settings of Track, and its button."""

    bl_label = "Track"
    bl_options: ClassVar = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return exists(TRACK)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        running = draw_job(layout, context, "track")
        column = layout.column()
        column.enabled = not running
        column.use_property_split = True
        column.use_property_decorate = False
        track = context.scene.mocap_assist.track
        column.prop(track, "way")
        if track.way == ForegroundWay.CUT.name:
            for name in CUT:
                column.prop(track, name)
        for name in SHOWN:
            column.prop(track, name)
        layout.operator(TRACK, icon="OUTLINER_OB_ARMATURE")
        if is_tracked(context.view_layer.objects.active):
            manager = context.window_manager
            layout.prop(manager, "mocap_assist_body", toggle=True, icon="MOD_SKIN")
        elif reason := why_not_track(context):
            draw_sentence(layout, context, reason, icon="INFO")
