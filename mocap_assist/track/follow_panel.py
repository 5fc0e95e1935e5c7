"""Panel: track an actor while a depth camera records."""

from typing import ClassVar

import bpy

from ...solvers.errors import InvalidSettingError
from ..blender.mixins import PanelMixin
from ..blender.path_properties import absolute
from ..panel_parts.panel_layout import draw_sentence, operator_exists, settings_column
from ..panel_parts.visibility import shows_all
from ..runtime.selection import selected_subject
from .following import NO_FOLDER
from .tracked_armature.body import is_tracked
from .tracking import selected_preview

FOLLOW = "mocap_assist.track_live"
CAMERA = (
    "unit", "focal_length", "focal_length_y", "center_x", "center_y", "frame_rate", "held",
    "mirrored",
)  # fmt: skip
FOLLOWING = ("calibration", "max_delay", "max_silence", "max_wait")
HOW = "Start, and move arms and legs for the calibration. Actor mask and feet are set in Track."


CHOSEN = "Press Track Live in the sidebar of the 3D View."


def choose_recording(scene: bpy.types.Scene, folder: str, name: str) -> str:
    """Set the recording to follow, so that the panel is shown; return a message.

    Raises InvalidSettingError if none is chosen.
    """
    if not folder and not name:
        raise InvalidSettingError(NO_FOLDER)
    scene.mocap_assist.track_live.recording_file = str(absolute(folder) / name)
    return CHOSEN


class TrackLivePanel(PanelMixin):
    """Settings of Track Live, and its button."""

    bl_label = "Track Live"
    bl_options: ClassVar = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        job = context.window_manager.mocap_assist_job
        is_running = job.running and job.owner == "track_live"
        is_chosen = bool(context.scene.mocap_assist.track_live.recording_file)
        suits = (
            (is_chosen and selected_subject(context) is None)
            or selected_preview(context) is not None
            or is_tracked(context.view_layer.objects.active)  # such as of the last take
        )
        return operator_exists(FOLLOW) and (suits or is_running or shows_all(context))

    def draw(self, context: bpy.types.Context) -> None:
        layout, live = self.layout, context.scene.mocap_assist.track_live
        column = settings_column(layout, context, "track_live")
        column.prop(live, "recording_file")
        header, body = column.panel("mocap_assist_live_camera", default_closed=True)
        header.label(text="Camera")
        for name in CAMERA if body else ():
            body.prop(live, name)
        header, body = column.panel("mocap_assist_live_following", default_closed=True)
        header.label(text="Following")
        for name in FOLLOWING if body else ():
            body.prop(live, name)
        row = layout.row()
        row.enabled = bool(live.recording_file)
        row.operator(FOLLOW, icon="REC")
        draw_sentence(layout, context, HOW if live.recording_file else NO_FOLDER, icon="INFO")
