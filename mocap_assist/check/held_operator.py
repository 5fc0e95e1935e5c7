"""An operator that shows the recorded action as long as its key is held."""

from typing import ClassVar

import bpy

from ..blender.mixins import OperatorMixin
from ..languages import translated
from . import raw_view

PASSED_EVENTS = {
    "MOUSEMOVE", "INBETWEEN_MOUSEMOVE", "NDOF_MOTION", "WHEELUPMOUSE", "WHEELDOWNMOUSE",
    "TRACKPADPAN", "TRACKPADZOOM",
}  # fmt: skip
"""Events that other operators get meanwhile: they move the view and change no data. Operators
that wait for the release of a button, such as orbiting, would take the release of the key."""
NOT_HELD = {"LEFTMOUSE", "RIGHTMOUSE", "MIDDLEMOUSE", "RET", "NUMPAD_ENTER"}
"""Events that choose an entry of a menu: there is no key to release then."""
HELD_TEXT = "{action}: release {key} for the result"
CLICKED_TEXT = "{action}: press any key or click for the result"


class HeldOperator(OperatorMixin):
    """Mixed in before bpy.types.Operator.

    Any other press ends it as well, and does nothing else: an edit would be stored by undo
    with the recorded action assigned.
    """

    bl_options: ClassVar[set[str]] = set()  # No undo step: nothing is changed in the end.
    _key = ""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if reason := raw_view.why_not_show_raw(context):
            cls.poll_message_set(translated(reason))
        return not reason

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Show the recorded action, and wait."""
        is_key = event.value == "PRESS" and event.type not in NOT_HELD
        self._key = event.type if is_key else ""
        action = raw_view.show_raw(context)
        template = translated(HELD_TEXT if self._key else CLICKED_TEXT)
        text = template.format(action=action, key=self._key)
        context.workspace.status_text_set(text)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """End with the key, with any other press, and when the window loses the focus."""
        if not raw_view.is_shown() or self._ends(event):
            self.cancel(context)
            return {"CANCELLED"}
        has_modifier = event.ctrl or event.alt or event.shift or event.oskey
        is_passed = event.type in PASSED_EVENTS and not has_modifier
        is_timer = event.type.startswith("TIMER")  # of the playback, for example
        return {"PASS_THROUGH"} if is_passed or is_timer else {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Show the result again; Blender calls this when the window closes, for example."""
        raw_view.restore_played()
        context.workspace.status_text_set(None)

    def _ends(self, event: bpy.types.Event) -> bool:
        if event.type == "WINDOW_DEACTIVATE":
            return True
        if event.type == self._key and event.value == "RELEASE":
            return True
        if event.type in PASSED_EVENTS or event.type.startswith("TIMER"):
            return False
        return event.value == "PRESS" and not event.is_repeat
