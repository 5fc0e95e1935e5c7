"""The three acts of every Mocap Assist operator: read the scene, solve, write the scene."""

import logging
from collections.abc import Callable
from functools import partial
from time import monotonic
from typing import Any, ClassVar

import bpy

from ..solvers.errors import MocapAssistError, SolveCancelled
from .jobs.job import Job, Quick, run
from .redo import fingerprint
from .selection import selected_subject
from .subject import Subject
from .watch import Watch, why_busy

logger = logging.getLogger(__name__)


def in_background() -> bool:
    """Whether there is nobody to press Esc, and no loop of events to wait in."""
    return bool(bpy.app.background)


class SolverOperator:
    """Mix in before bpy.types.Operator and name the functions that read and write.

    They run in Blender. What `read_scene` returns is called with `progress=` in a process of
    its own: it must be picklable and cannot use bpy. When the animator pressed a button, that
    window swallows all input but Esc and the right mouse button meanwhile; whatever is done in
    another window, the result goes to what was read, or nowhere. A script waits.
    """

    bl_options: ClassVar = {"REGISTER", "UNDO"}
    settings_group: ClassVar[str]
    """Where the sidebar keeps the settings: a property of `scene.mocap_assist`."""
    setting_names: ClassVar[tuple[str, ...]]
    """Supplied by the decorator `settings_from`, as is the method `settings`."""
    selected: ClassVar[Callable[..., bpy.types.Object | None]] = selected_subject
    """From the context, what the button works on."""
    why_not: ClassVar[Callable[[bpy.types.Context], str]]
    """Return why the button is grey, or nothing."""
    read_scene: ClassVar[Callable[..., "partial[Any]"]]
    """From scene, subject and settings; the first argument of the solve is what is solved."""
    write_scene: ClassVar[Callable[..., str]]
    """From scene, subject, settings, result and the fingerprint of what was solved.

    Returns the sentence to show in the status bar.
    """

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if reason := why_busy() or cls.why_not(context):
            cls.poll_message_set(reason)
        return not reason

    def prepare(self, context: bpy.types.Context) -> None:
        """Take over the sidebar's settings, but for those that the caller gave."""
        shown = getattr(context.scene.mocap_assist, self.settings_group)
        for name in type(self).setting_names:
            if hasattr(shown, name) and not self.properties.is_property_set(name):
                setattr(self, name, getattr(shown, name))

    def execute(self, context: bpy.types.Context) -> set[str]:
        if not hasattr(self, "_subject"):  # else it is done again, to the same subject
            self._subject = Subject.of(context.scene, type(self).selected(context))
        try:
            return self._finish(run(self._read()))
        except MocapAssistError as error:
            return self._give_up(error)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self.prepare(context)
        if in_background():
            return self.execute(context)
        self._subject = Subject.of(context.scene, type(self).selected(context))
        self._started = monotonic()
        try:
            solve = self._read()
            if isinstance(solve, Quick):
                return self._finish(run(solve))
            self._asked = fingerprint(solve.args[0])
            self._watch = Watch(context, solve, self.settings_group)
        except MocapAssistError as error:
            return self._give_up(error)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        watch = self._watch
        if not watch.is_on:
            return {"CANCELLED"}
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            watch.job.cancel()
        elif event.type != "TIMER":
            return {"RUNNING_MODAL"}
        elif not watch.job.done():
            watch.show(context, *watch.job.progress())
            return {"RUNNING_MODAL"}
        watch.end(context)
        logger.info("%s took %.1f s", self.bl_idname, monotonic() - self._started)
        try:
            return self._finish(self._answer(watch.job), self._asked)
        except MocapAssistError as error:
            return self._give_up(error)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the operator: another file is loaded, or the window closes."""
        if self._watch.is_on:
            self._watch.abandon(context)

    def _answer(self, job: Job[Any]) -> Any:
        """Return what the job that has ended has solved."""
        return job.result()

    def _read(self) -> "partial[Any]":
        return type(self).read_scene(*self._subject.find(), self.settings())

    def _finish(self, result: Any, asked: str | None = None) -> set[str]:
        scene, thing = self._subject.find()
        said = type(self).write_scene(scene, thing, self.settings(), result, asked)
        self.report({"INFO"}, said)
        return {"FINISHED"}

    def _give_up(self, error: MocapAssistError) -> set[str]:
        cancelled = isinstance(error, SolveCancelled)
        self.report({"INFO"} if cancelled else {"ERROR"}, str(error))
        return {"CANCELLED"}
