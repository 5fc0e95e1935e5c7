"""The button Build Library: it waits without blocking the window."""

import logging
from functools import partial

import bpy

from ...solvers.errors import MocapAssistError, SolveCancelled
from ..blender.last_press import note_press
from ..blender.mixins import SettingsMixin
from ..jobs.job import run
from ..languages import translated
from ..runtime.solver_operator import in_background
from .background import Indexing, message_of, why_indexing
from .solve_indexing import Indexed, index_sources
from .sources import index_problem

logger = logging.getLogger(__name__)

POLL_INTERVAL_S = 0.25
"""Seconds between two queries of the background job. It bounds the delay of its progress."""
MAX_NAMED_FILES = 3
"""Number of unusable files that a message names; the log has all."""


class WaitingIndex(SettingsMixin):
    """Mix in before bpy.types.Operator.

    The window stays free meanwhile: nothing of the scene is read or written. Only Esc is taken,
    and ends it.
    """

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if reason := why_indexing():
            cls.poll_message_set(translated(reason))
        return not reason

    def prepare(self, context: bpy.types.Context) -> None:
        """Take over the sidebar's settings, but for those that the caller gave."""
        shown = context.scene.mocap_assist.library
        for name in type(self).setting_names:
            if not self.properties.is_property_set(name):
                setattr(self, name, getattr(shown, name))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Index while a script waits."""
        self.prepare(context)
        try:
            return self._report(run(self._solve()))
        except MocapAssistError as error:
            return self._give_up(error)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if in_background():
            return self.execute(context)
        self.prepare(context)
        try:
            self._indexing = Indexing(context, self._solve())
        except MocapAssistError as error:
            return self._give_up(error)
        manager = context.window_manager
        self._timer = manager.event_timer_add(POLL_INTERVAL_S, window=context.window)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        indexing = self._indexing
        if not indexing.is_on:
            self._stop_looking(context)
            return {"CANCELLED"}
        if event.type == "ESC" and event.value == "PRESS":
            indexing.job.cancel()
        elif event.type != "TIMER":
            return {"PASS_THROUGH"}
        elif not indexing.job.done():
            indexing.show(context)
            return {"PASS_THROUGH"}
        self._stop_looking(context)
        try:
            indexed = indexing.job.result()
        except MocapAssistError as error:
            indexing.end(context, "")
            return self._give_up(error)
        indexing.end(context, message_of(indexed))
        return self._report(indexed)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the operator: another file is loaded, or the window closes."""
        self._stop_looking(context)
        if self._indexing.is_on:
            self._indexing.abandon(context)

    def _solve(self) -> "partial[Indexed]":
        return partial(index_sources, index_problem(self.settings().choices))

    def _stop_looking(self, context: bpy.types.Context) -> None:
        context.window_manager.event_timer_remove(self._timer)

    def _report(self, indexed: Indexed) -> set[str]:
        for sentence in indexed.refused:
            logger.warning("%s", sentence)
        note_press(self)
        more = len(indexed.refused) - MAX_NAMED_FILES
        named = [*indexed.refused[:MAX_NAMED_FILES], *[f"And {more} more."] * (more > 0)]
        level = {"WARNING"} if indexed.refused else {"INFO"}
        self.report(level, translated(" ".join([message_of(indexed), *named])))
        return {"FINISHED"}

    def _give_up(self, error: MocapAssistError) -> set[str]:
        cancelled = isinstance(error, SolveCancelled)
        note_press(self, error)
        self.report({"INFO"} if cancelled else {"ERROR"}, translated(str(error)))
        return {"CANCELLED"}
