"""Buttons that act at once: whether they can, what they did, and why not."""

from collections.abc import Callable
from typing import ClassVar

import bpy

from ...solvers.errors import MocapAssistError
from ..languages import translated
from .last_press import note_press, noted_errors
from .mixins import OperatorMixin


def _no_reason(context: bpy.types.Context) -> str:
    return ""


class ActOperator(OperatorMixin):
    """Mix in before an operator that defines `act` or `execute`, and `why_not` unless it is
    never gray."""

    why_not: ClassVar[Callable[[bpy.types.Context], str]] = _no_reason
    """Return why the button is unavailable, or an empty text."""
    act: Callable[[bpy.types.Context], str]
    """Act, and return the message for the status bar: a method of the operator."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if reason := cls.why_not(context):
            cls.poll_message_set(translated(reason))
        return not reason

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Act, and report the result or the error."""
        try:
            with noted_errors(self):
                message = self.act(context)
        except MocapAssistError as error:
            self.report({"ERROR"}, translated(str(error)))
            return {"CANCELLED"}
        note_press(self)
        self.report({"INFO"}, translated(message))
        return {"FINISHED"}
