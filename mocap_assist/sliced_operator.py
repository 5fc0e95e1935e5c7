"""A button whose result is so large that it is written a little at a time."""

from time import monotonic
from typing import Any, ClassVar, Protocol

import bpy

from ..solvers.errors import MocapAssistError
from .solver_operator import SolverOperator

AT_ONCE = 0.05
"""Seconds of writing between two looks at what the animator does."""


class Writer(Protocol):
    """Writes a result in steps."""

    fraction: float

    def step(self, scene: bpy.types.Scene, thing: bpy.types.Object) -> str:
        """Write a little; return a sentence once all is written."""

    def take_back(self) -> None:
        """Remove what was written."""


class SlicedOperator(SolverOperator):
    """Mix in as SolverOperator; Esc ends the writing, too, and removes what was written."""

    write_scene: ClassVar[type[Writer]]
    _writer: Writer | None = None

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        watch = self._watch
        if not watch.is_on:
            return {"CANCELLED"}
        if self._writer is not None:
            return self._go_on(context, event)
        if event.type != "TIMER" or not watch.job.done():
            return super().modal(context, event)
        try:
            self._writer = self._start(watch.job.result(), self._asked)
        except MocapAssistError as error:
            watch.end(context)
            return self._give_up(error)
        return {"RUNNING_MODAL"}

    def _start(self, result: Any, asked: str | None = None) -> Writer:
        return type(self).write_scene(*self._subject.find(), self.settings(), result, asked)

    def _go_on(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        writer, watch = self._writer, self._watch
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            writer.take_back()
            watch.end(context)
            self.report({"INFO"}, "Cancelled.")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        try:
            said = self._write(writer, monotonic() + AT_ONCE)
        except MocapAssistError as error:
            writer.take_back()
            watch.end(context)
            return self._give_up(error)
        if not said:
            watch.show(context, writer.fraction, "Writing")
            return {"RUNNING_MODAL"}
        watch.end(context)
        self.report({"INFO"}, said)
        return {"FINISHED"}

    def _finish(self, result: Any, asked: str | None = None) -> set[str]:
        """Write all at once: nobody looks on."""
        writer = self._start(result, asked)
        try:
            said = self._write(writer)
        except MocapAssistError:
            writer.take_back()
            raise
        self.report({"INFO"}, said)
        return {"FINISHED"}

    def _write(self, writer: Writer, until: float = float("inf")) -> str:
        """Write until all is written, or some time has come; return the sentence, if any."""
        said = writer.step(*self._subject.find())
        while not said and monotonic() < until:
            said = writer.step(*self._subject.find())
        return said
