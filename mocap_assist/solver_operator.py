"""The three acts of every Mocap Assist operator: read the scene, solve, write the scene."""

import logging
from collections.abc import Callable
from time import monotonic
from typing import Any, ClassVar

import bpy

from ..solvers.errors import MocapAssistError, SolveCancelled
from .jobs.job import Job, Quick, run

logger = logging.getLogger(__name__)
BETWEEN_LOOKS = 0.1  # seconds


def in_background() -> bool:
    """Whether there is nobody to press Esc, and no loop of events to wait in."""
    return bool(bpy.app.background)


class SolverOperator:
    """Mix in before bpy.types.Operator and implement `read` and `write`.

    `read` and `write` run in Blender. What `read` returns is called with `progress=` in a
    process of its own: it must be picklable and cannot use bpy. When the animator pressed a
    button, all input but Esc and the right mouse button is swallowed meanwhile, so that the
    scene that was read is the scene that is written; a script waits.
    """

    bl_options: ClassVar = {"REGISTER", "UNDO"}
    settings_group: ClassVar[str]
    """Where the sidebar keeps the settings: a property of `scene.mocap_assist`."""
    setting_names: ClassVar[tuple[str, ...]]
    """Supplied by the decorator `settings_from`."""

    def read(self, context: bpy.types.Context) -> Callable[..., Any]:
        raise NotImplementedError

    def write(self, context: bpy.types.Context, result: Any) -> str:
        """Return the sentence to show in the status bar."""
        raise NotImplementedError

    def prepare(self, context: bpy.types.Context) -> None:
        """Take over the sidebar's settings, but for those that the caller gave."""
        shown = getattr(context.scene.mocap_assist, self.settings_group)
        for name in type(self).setting_names:
            if hasattr(shown, name) and not self.properties.is_property_set(name):
                setattr(self, name, getattr(shown, name))

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            return self._finish(context, run(self.read(context)))
        except MocapAssistError as error:
            return self._give_up(error)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self.prepare(context)
        if in_background():
            return self.execute(context)
        try:
            solve = self.read(context)
            if isinstance(solve, Quick):
                return self._finish(context, run(solve))
            self._job = Job(solve)
        except MocapAssistError as error:
            return self._give_up(error)
        self._started = monotonic()
        manager = context.window_manager
        self._timer = manager.event_timer_add(BETWEEN_LOOKS, window=context.window)
        manager.modal_handler_add(self)
        self._show(context, 0.0, "Starting")
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            self._job.cancel()
        elif event.type != "TIMER":
            return {"RUNNING_MODAL"}
        elif not self._job.done():
            self._show(context, *self._job.progress())
            return {"RUNNING_MODAL"}
        self._stop_showing(context)
        try:
            return self._finish(context, self._job.result())
        except MocapAssistError as error:
            return self._give_up(error)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the operator: another file is loaded, or the window closes."""
        self._job.cancel()
        self._job.tidy_up()
        self._stop_showing(context)

    def _finish(self, context: bpy.types.Context, result: Any) -> set[str]:
        self.report({"INFO"}, self.write(context, result))
        return {"FINISHED"}

    def _give_up(self, error: MocapAssistError) -> set[str]:
        cancelled = isinstance(error, SolveCancelled)
        self.report({"INFO"} if cancelled else {"ERROR"}, str(error))
        return {"CANCELLED"}

    def _show(self, context: bpy.types.Context, fraction: float, message: str) -> None:
        state = context.window_manager.mocap_assist_job
        state.running, state.fraction, state.message = True, fraction, message
        context.workspace.status_text_set(f"{message} {fraction:.0%}   Esc: cancel")
        for window in context.window_manager.windows:
            for area in window.screen.areas:
                area.tag_redraw()

    def _stop_showing(self, context: bpy.types.Context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.mocap_assist_job.running = False
        context.workspace.status_text_set(None)
        logger.info("%s took %.1f s", self.bl_idname, monotonic() - self._started)
