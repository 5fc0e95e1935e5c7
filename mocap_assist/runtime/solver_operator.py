"""The three steps of every Mocap Assist operator: read the scene, solve, write the scene."""

import logging
from collections.abc import Callable, Generator
from functools import partial
from time import monotonic
from typing import Any, ClassVar

import bpy

from ...solvers.errors import MocapAssistError, OutOfMemoryError, SolveCancelled
from ..blender.last_press import note_press, noted_errors
from ..blender.mixins import SettingsMixin
from ..blender.time_slices import Work, in_thread
from ..jobs.job import Job, run, runs_here
from ..languages import translated
from .after_result import notify_listeners
from .navigation import is_in_status_bar, may_pass
from .redo import fingerprint
from .selection import selected_subject
from .subject import Subject
from .watch import TIMER_INTERVAL_S, Watch, why_busy

logger = logging.getLogger(__name__)

MAX_SLICE_S = 0.04
"""Seconds of work in Blender's main thread between two checks for events. It bounds the delay
of a click to a frame of 25 Hz."""


def in_background() -> bool:
    """Whether Blender runs without a window, and so without Esc and an event loop."""
    return bool(bpy.app.background)


class SolverOperator(SettingsMixin):
    """Mix in before bpy.types.Operator and name the functions that read and write.

    Both run in Blender, and `Sliced` ones take turns with its window. The solve that
    `read_scene` returns is called with `progress=` in a subprocess: it must be picklable and
    cannot use bpy. After a press of the button the window ignores all input except Esc, the
    right mouse button and, while another process solves, what only moves a view or the frame.
    Changes in another window do not redirect the result: it goes to the subject that was read,
    or is discarded. A script waits.
    """

    bl_options: ClassVar = {"REGISTER", "UNDO"}
    _is_solving = False
    settings_group: ClassVar[str]
    """Property of `scene.mocap_assist` with the settings of the sidebar."""
    look_interval_s: ClassVar[float] = TIMER_INTERVAL_S
    """Seconds between two looks at the solve, and its previews."""
    selected: ClassVar[Callable[..., bpy.types.Object | None]] = selected_subject
    """Return the subject of the button from the context."""
    why_not: ClassVar[Callable[[bpy.types.Context], str]]
    """Return why the button is unavailable, or an empty text."""
    read_scene: ClassVar[Callable[..., "partial[Any]"]]
    """Return the solve for a scene, subject and settings; its first argument is the problem."""
    write_scene: ClassVar[Callable[..., str]]
    """Write a result, and return the message for the status bar.

    It is called with scene, subject, settings, result and the fingerprint of the problem.
    """

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if reason := why_busy() or cls.why_not(context):
            cls.poll_message_set(translated(reason))
        return not reason

    def prepare(self, context: bpy.types.Context) -> None:
        """Copy the sidebar's settings, except those that the caller has set."""
        self.copy_settings(getattr(context.scene.mocap_assist, self.settings_group))

    def copy_settings(self, shown: bpy.types.PropertyGroup) -> None:
        """Copy settings of the sidebar, except those that the caller has set."""
        for name in type(self).setting_names:
            if hasattr(shown, name) and not self.properties.is_property_set(name):
                setattr(self, name, getattr(shown, name))

    def remember(self, context: bpy.types.Context) -> None:
        """Remember the subject in a form that survives undo."""
        self._subject = Subject.of(context.scene, type(self).selected(context))

    def execute(self, context: bpy.types.Context) -> set[str]:
        if not hasattr(self, "_subject"):  # otherwise a redo, for the same subject
            self.remember(context)
        try:
            with noted_errors(self):
                result = run(type(self).read_scene(*self._read_arguments()))
                message = type(self).write_scene(*self._read_arguments(), result, None)
        except (MocapAssistError, MemoryError) as error:
            return self._give_up(error)
        return self._finish(message)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self.prepare(context)
        if in_background():
            return self.execute(context)
        self.remember(context)
        self._started = monotonic()
        self._acts = self._perform()
        try:
            progress = next(self._acts)
        except StopIteration as end:
            return self._finish(end.value)
        except (MocapAssistError, MemoryError) as error:
            return self._give_up(error)
        except BaseException as error:
            note_press(self, error)
            raise
        self._watch = Watch(
            context,
            self.settings_group,
            self._acts.close,
            type(self).look_interval_s,
            is_quiet=not self.is_requested(),
        )
        self._watch.show(context, *progress)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        watch = self._watch
        if not watch.is_on:
            return {"CANCELLED"}
        escaped = event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS"
        escaped = (escaped and not event.is_repeat) or watch.is_cancelled
        escaped, watch.is_cancelled = escaped and self.heeds_esc(), False
        if not escaped and event.type != "TIMER":
            return {"PASS_THROUGH"} if self.lets_pass(context, event) else {"RUNNING_MODAL"}
        try:
            acts = self._acts
            progress = acts.throw(SolveCancelled("Cancelled.")) if escaped else next(acts)
        except StopIteration as end:
            watch.end(context)
            return self._finish(end.value)
        except (MocapAssistError, MemoryError) as error:
            watch.end(context)
            return self._give_up(error)
        except BaseException as error:
            note_press(self, error)
            watch.end(context)
            raise
        watch.show(context, *progress)
        return {"RUNNING_MODAL"}

    def is_requested(self) -> bool:
        """Return whether the animator pressed the button."""
        return True

    def heeds_esc(self) -> bool:
        """Return whether Esc and Cancel have an effect now."""
        return True

    def lets_pass(self, context: bpy.types.Context, event: bpy.types.Event) -> bool:
        """Return whether an event reaches Blender's editors now."""
        is_cancel = is_in_status_bar(context, event)
        return is_cancel or (self._is_solving and may_pass(context, event))

    def cancel(self, context: bpy.types.Context) -> None:
        """Stop because Blender loads another file or closes the window."""
        if self._watch.is_on:
            self._watch.abandon(context)

    def show_previews(self, job: Job[Any]) -> None:
        """Show previews of a running solve; does nothing by default."""

    def progress_of(self, job: Job[Any]) -> tuple[float, str]:
        """Return the fraction, 0 to 1, and the message of a running job."""
        return job.progress()

    def ends_early(self, job: Job[Any]) -> bool:
        """Return whether a job that Esc is to end goes on to its result so far.

        By default it does not: it is cancelled.
        """
        return False

    def result_from_job(self, job: Job[Any]) -> Any:
        """Return the result of a job that has ended."""
        return job.result()

    def _perform(self) -> Generator[tuple[float, str], None, str]:
        """Read, solve and write in turns with Blender; yield the progress.

        SolveCancelled is thrown in when the animator presses Esc.
        """
        solve = yield from self._in_slices(
            "Reading", type(self).read_scene, *self._read_arguments()
        )
        digest = partial(fingerprint, solve.args[0])
        problem_digest = yield from self._in_slices("Reading", in_thread, digest)
        result = run(solve) if runs_here(solve) else (yield from self._solve(solve))
        message: str = yield from self._in_slices(
            "Writing", type(self).write_scene, *self._read_arguments(), result, problem_digest
        )
        logger.info("%s took %.1f s", self.bl_idname, monotonic() - self._started)
        return message

    def _in_slices(
        self, title: str, function: Callable[..., Any], *arguments: Any
    ) -> Generator[tuple[float, str], None, Any]:
        work = Work(function, *arguments)
        try:
            while not work.run_slice(MAX_SLICE_S):
                yield work.fraction, title
        finally:
            work.stop()
        return work.result

    def _solve(self, solve: "partial[Any]") -> Generator[tuple[float, str], None, Any]:
        started: list[Job[Any]] = []

        def start() -> None:
            started.append(Job(solve))

        try:
            # In a thread, since the request of a long take is a large file.
            yield from self._in_slices("Starting", in_thread, start, 0.0)
            self._job = job = started[0]
            self._is_solving = True
            yield from self._watch_job(job)
        except SolveCancelled:
            if not started:
                raise
            started[0].cancel()
        except BaseException:  # the file is closed, or the extension disabled
            for job in started:
                job.cancel()
                job.tidy_up()
            raise
        finally:
            self._is_solving = False
        return self.result_from_job(started[0])

    def _watch_job(self, job: Job[Any]) -> Generator[tuple[float, str], None, None]:
        while not job.done():
            self.show_previews(job)
            try:
                yield self.progress_of(job)
            except SolveCancelled:
                if not self.ends_early(job):
                    raise

    def _read_arguments(self) -> tuple[Any, ...]:
        return (*self._subject.find(), self.settings())

    def _finish(self, message: str) -> set[str]:
        note_press(self)
        if "UNDO" in self.bl_options:
            notify_listeners(self._subject.scene.find())
        self.report({"INFO"}, translated(message))
        return {"FINISHED"}

    def _give_up(self, error: MocapAssistError | MemoryError) -> set[str]:
        if isinstance(error, MemoryError):
            error = OutOfMemoryError()
        cancelled = isinstance(error, SolveCancelled)
        note_press(self, error)
        self.report({"INFO"} if cancelled else {"ERROR"}, translated(str(error)))
        return {"CANCELLED"}
