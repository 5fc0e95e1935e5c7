"""Panel: search by performing in front of a camera."""

from typing import ClassVar

import bpy

from ..blender.mixins import PanelMixin
from ..panel_parts.panel_layout import (
    draw_sentence,
    operator_exists,
    settings_column,
    split_column,
)
from ..panel_parts.preference_values import preferences
from ..panel_parts.visibility import shows_take
from ..runtime.selection import selected_armature
from .listening import Listening, current
from .stream_state import issue_text, sender_text

LISTEN = "mocap_assist.listen"
RECORD = "mocap_assist.record_live"
PURPOSE = "Search the library with gestures, or record a live stream."
STREAM = "live_protocol", "live_person"
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
        return operator_exists(LISTEN) and (is_listening or shows_take(context))

    def draw(self, context: bpy.types.Context) -> None:
        listening = current()
        if listening is None:
            _draw_buttons(self.layout, context)
        else:
            _draw_stream(self.layout, context, listening)


def _draw_buttons(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the settings of the stream, and the buttons that receive it."""
    live = context.scene.mocap_assist.live
    draw_sentence(layout, context, PURPOSE)
    column = split_column(layout)
    if preferences() is not None:
        column.prop(preferences(), "live_port")
    for name in STREAM:
        column.prop(live, name)
    layout.operator(LISTEN, icon="OUTLINER_OB_ARMATURE")
    if operator_exists(RECORD) and selected_armature(context) is not None:
        column = settings_column(layout, context, "live")
        header, body = column.panel("mocap_assist_live_recording", default_closed=True)
        header.label(text="Recording")
        for name in SETTINGS if body else ():
            body.prop(live, name)
        layout.operator(RECORD, icon="REC")


def _draw_stream(
    layout: bpy.types.UILayout, context: bpy.types.Context, listening: Listening
) -> None:
    """Draw what can be performed now, and what was received."""
    layout.operator(LISTEN, text="Stop Listening", icon="CANCEL")
    draw_sentence(layout, context, listening.state())
    if listening.message:
        draw_sentence(layout, context, listening.message, icon="INFO")
    if sender := sender_text(listening.stream_state):
        draw_sentence(layout, context, sender)
    if issue := issue_text(listening.stream_state):
        draw_sentence(layout, context, issue, icon="ERROR")
