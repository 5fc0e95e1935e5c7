"""The three acts of every Mocap Assist operator: read the scene, solve, write the scene."""

import logging
from collections.abc import Callable, Generator
from functools import partial
from time import monotonic
from typing import Any, ClassVar

import bpy

from ...solvers.errors import MocapAssistError, OutOfMemoryError, SolveCancelled
from ..blender.mixins import SettingsMixin
from ..blender.time_slices import Work
from ..jobs.job import Job, ShortSolve, run
from .redo import fingerprint
from .selection import selected_subject
from .subject import Subject
from .watch import Watch, why_busy

logger = logging.getLogger(__name__)

AT_ONCE = 0.04
"""Seconds of work in Blender's own thread between two looks at what the animator does."""


def in_background() -> bool:
    """Whether there is nobody to press Esc, and no loop of events to wait in."""
    return bool(bpy.app.background)


class SolverOperator(SettingsMixin):
    """Mix in before bpy.types.Operator and name the functions that read and write.

    They run in Blender, in turns with its window where they are `Sliced`. What `read_scene`
    returns is called with `progress=` in a process of its own: it must be picklable and cannot
    use bpy. When the animator pressed a button, that window swallows all input but Esc and the
    right mouse button meanwhile; whatever is done in another window, the result goes to what
    was read, or nowhere. A script waits.
    """

    bl_options: ClassVar = {"REGISTER", "UNDO"}
    settings_group: ClassVar[str]
    """Where the sidebar keeps the settings: a property of `scene.mocap_assist`."""
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
            result = run(type(self).read_scene(*self._read_arguments()))
            message = type(self).write_scene(*self._read_arguments(), result, None)
        except (MocapAssistError, MemoryError) as error:
            return self._give_up(error)
        return self._finish(message)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self.prepare(context)
        if in_background():
            return self.execute(context)
        self._subject = Subject.of(context.scene, type(self).selected(context))
        self._started = monotonic()
        self._acts = self._perform()
        try:
            progress = next(self._acts)
        except StopIteration as end:
            return self._finish(end.value)
        except (MocapAssistError, MemoryError) as error:
            return self._give_up(error)
        self._watch = Watch(context, self.settings_group, self._acts.close)
        self._watch.show(context, *progress)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        watch = self._watch
        if not watch.is_on:
            return {"CANCELLED"}
        escaped = event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS"
        if not escaped and event.type != "TIMER":
            return {"RUNNING_MODAL"}
        try:
            acts = self._acts
            progress = acts.throw(SolveCancelled("Cancelled.")) if escaped else next(acts)
        except StopIteration as end:
            watch.end(context)
            return self._finish(end.value)
        except (MocapAssistError, MemoryError) as error:
            watch.end(context)
            return self._give_up(error)
        except BaseException:
            watch.end(context)
            raise
        watch.show(context, *progress)
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the operator: another file is loaded, or the window closes."""
        if self._watch.is_on:
            self._watch.abandon(context)

    def look(self, job: Job[Any]) -> None:
        """Do something now and then while it is solved; nothing here."""

    def answer(self, job: Job[Any]) -> Any:
        """Return what the job that has ended has solved."""
        return job.result()

    def _perform(self) -> Generator[tuple[float, str], None, str]:
        """Read, solve and write in turns with Blender; yield how far it is.

        SolveCancelled is thrown in when the animator presses Esc.
        """
        solve = yield from self._in_turns("Reading", type(self).read_scene)
        asked = fingerprint(solve.args[0])
        result = (
            run(solve) if isinstance(solve, ShortSolve) else (yield from self._solve(solve))
        )
        message: str = yield from self._in_turns(
            "Writing", type(self).write_scene, result, asked
        )
        logger.info("%s took %.1f s", self.bl_idname, monotonic() - self._started)
        return message

    def _in_turns(
        self, title: str, function: Callable[..., Any], *more: Any
    ) -> Generator[tuple[float, str], None, Any]:
        work = Work(function, *self._read_arguments(), *more)
        try:
            while not work.go_on(AT_ONCE):
                yield work.fraction, title
        finally:
            work.stop()
        return work.result

    def _solve(self, solve: "partial[Any]") -> Generator[tuple[float, str], None, Any]:
        self._job = job = Job(solve)
        try:
            while not job.done():
                self.look(job)
                yield job.progress()
        except SolveCancelled:
            job.cancel()
        except BaseException:  # the file is closed, or the extension switched off
            job.cancel()
            job.tidy_up()
            raise
        return self.answer(job)

    def _read_arguments(self) -> tuple[Any, ...]:
        return (*self._subject.find(), self.settings())

    def _finish(self, message: str) -> set[str]:
        self.report({"INFO"}, message)
        return {"FINISHED"}

    def _give_up(self, error: MocapAssistError | MemoryError) -> set[str]:
        if isinstance(error, MemoryError):
            error = OutOfMemoryError()
        cancelled = isinstance(error, SolveCancelled)
        self.report({"INFO"} if cancelled else {"ERROR"}, str(error))
        return {"CANCELLED"}
