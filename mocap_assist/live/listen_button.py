"""The button that starts and ends listening."""

from typing import ClassVar

import bpy

from ...solvers.errors import MocapAssistError
from ...solvers.recordings.streams import StreamProtocol
from ..blender.last_press import note_press, noted_errors
from ..blender.mixins import OperatorMixin
from ..languages import translated
from ..panel_parts.preference_values import preference_value
from . import listening
from .stream_preferences import allowed_addresses, live_port

NO_WINDOW = "Listening needs Blender's window."


class ListenButton(OperatorMixin):
    """Mix in before bpy.types.Operator: pressed once it listens, and again it stops."""

    bl_options: ClassVar = set[str]()  # changes only views and the list of matches

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if bpy.app.background:
            cls.poll_message_set(translated(NO_WINDOW))
            return False
        return True

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        running = listening.current()
        if running is not None:
            running.end(context)
            return {"FINISHED"}
        try:
            with noted_errors(self):
                self._listening = listening.Listening(
                    context,
                    live_port(),
                    StreamProtocol[context.scene.mocap_assist.live.live_protocol],
                    allowed_addresses(),
                    context.scene.mocap_assist.live.live_person,
                    tuple(preference_value("clean_color")),
                    preference_value("line_width"),
                )
        except MocapAssistError as error:
            self.report({"ERROR"}, translated(str(error)))
            return {"CANCELLED"}
        note_press(self)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if not self._listening.is_on:
            return {"CANCELLED"}
        if event.type == "ESC" and event.value == "PRESS":
            self._listening.end(context)
            return {"FINISHED"}
        if event.type == "TIMER":
            self._listening.poll(context)
        return {"PASS_THROUGH"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the operator: another file is loaded, or the window closes."""
        self._listening.end(context)
