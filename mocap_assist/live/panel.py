"""Panel: search by performing before a camera."""

from typing import ClassVar

import bpy

from ..blender.mixins import PanelMixin
from ..panels.drawing import draw_sentence, exists
from ..panels.preference_values import preferences
from ..panels.visibility import shows_take
from .listening import current

LISTEN = "mocap_assist.listen"


class PerformPanel(PanelMixin):
    """The button Listen, the port, and what is heard."""

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
            return
        layout.operator(LISTEN, text="Stop Listening", icon="CANCEL")
        draw_sentence(layout, context, listening.state())
        if listening.message:
            draw_sentence(layout, context, listening.message, icon="INFO")
        heard = listening.heard
        draw_sentence(layout, context, f"{heard.frames} frames, {heard.dropped} dropped")
        if heard.why:
            draw_sentence(layout, context, heard.why, icon="ERROR")
