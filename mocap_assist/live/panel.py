"""Panel: search by performing in front of a camera."""

from typing import ClassVar

import bpy

from ..blender.mixins import PanelMixin
from ..panel_parts.panel_layout import draw_sentence, exists, settings_column
from ..panel_parts.preference_values import preferences
from ..panel_parts.visibility import shows_take
from ..runtime.selection import selected_armature
from .listening import current
from .stream_state import issue_text, sender_text

LISTEN = "mocap_assist.listen"
RECORD = "mocap_assist.record_live"
SETTINGS = (
    "duration", "live_limbs", "hold_feet", "keep_limits", "calibration_s", "smoothing",
)  # fmt: skip


class PerformPanel(PanelMixin):
    """The buttons Listen and Record Live, the port, and the state of the stream."""

    bl_label = "Perform"
    bl_options: ClassVar = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        is_listening = current() is not None
        return exists(LISTEN) and (is_listening or shows_take(context))

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        listening = current()
        if listening is None:
            layout.operator(LISTEN, icon="OUTLINER_OB_ARMATURE")
            if preferences() is not None:
                layout.prop(preferences(), "live_port")
            layout.prop(context.scene.mocap_assist.live, "live_protocol")
            layout.prop(context.scene.mocap_assist.live, "live_person")
            if exists(RECORD) and selected_armature(context) is not None:
                column = settings_column(layout, context, "live")
                live = context.scene.mocap_assist.live
                for name in SETTINGS:
                    column.prop(live, name)
                layout.operator(RECORD, icon="REC")
            return
        layout.operator(LISTEN, text="Stop Listening", icon="CANCEL")
        draw_sentence(layout, context, listening.state())
        if listening.message:
            draw_sentence(layout, context, listening.message, icon="INFO")
        stream = listening.stream_state
        if sender := sender_text(stream):
            draw_sentence(layout, context, sender)
        if issue := issue_text(stream):
            draw_sentence(layout, context, issue, icon="ERROR")
