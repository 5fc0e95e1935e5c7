"""Fix many takes one after another: pause between two, go on after a failure, stop on Esc."""

from collections.abc import Generator
from time import monotonic, sleep
from typing import ClassVar

import bpy

from ...solvers.errors import MocapAssistError, SolveCancelled
from ..blender.path_properties import FOLDER, HIDDEN, absolute, path_property
from ..jobs.job import POLL_INTERVAL_S
from ..languages import translated
from ..runtime.watched_operator import WatchedOperator
from .queue import (
    QueuedTake,
    Status,
    action_numbers,
    show_status,
    show_takes,
    shown_queue,
    takes_of,
)
from .scene_fixing import push_undo

POINTER = {"MOUSEMOVE", "LEFTMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE", "TRACKPADPAN"}
"""Events that the sidebar receives during the work, for its button Pause."""


def always(context: bpy.types.Context) -> str:
    """Return an empty text: the button is never gray, and a folder needs no selection."""
    return ""


class QueueOperator(WatchedOperator):
    """Mix in like WatchedOperator: its button works on each take of a queue.

    Each fixed take is an undo step of its own, so that one can be undone without the others.
    """

    bl_options: ClassVar = {"REGISTER"}
    directory: path_property(FOLDER, HIDDEN)
    _is_paused = False

    def remember(self, context: bpy.types.Context) -> None:
        """List the takes."""
        folder = absolute(self.directory) if self.directory else None
        self._takes: list[QueuedTake] = takes_of(context, folder)
        show_takes(self._takes)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        try:
            return super().invoke(context, event)
        except MocapAssistError as error:  # of the folder
            return self._give_up(error)

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            self.remember(context)
            acts = self._perform()
            while True:
                next(acts)
                sleep(POLL_INTERVAL_S)
        except StopIteration as end:
            return self._finish(end.value)
        except MocapAssistError as error:
            return self._give_up(error)

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        is_escape = event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS"
        is_escape = is_escape or (self._watch.is_on and self._watch.is_cancelled)
        if event.type == "TIMER" or is_escape or not self._watch.is_on:
            status = super().modal(context, event)
            # The sidebar's buttons need the timer of their tooltips.
            return {"PASS_THROUGH"} if status == {"RUNNING_MODAL"} else status
        passes = self._is_paused or (event.type in POINTER and _over_sidebar(event))
        passes = passes or self.lets_pass(context, event)
        return {"PASS_THROUGH"} if passes else {"RUNNING_MODAL"}

    def _wait_while_paused(self) -> Generator[tuple[float, str], None, None]:
        while shown_queue().paused:
            self._is_paused = True
            yield 0.0, translated("Paused")
        self._is_paused = False

    def _perform(self) -> Generator[tuple[float, str], None, str]:
        n_failed = 0
        for index, take in enumerate(self._takes):
            try:
                yield from self._wait_while_paused()
                show_status(index, Status.RUNNING)
                self._started, before = monotonic(), action_numbers()
                self._subject = yield from take.bring(bpy.context)
                message = yield from super()._perform()
            except (SolveCancelled, GeneratorExit) as end:
                if isinstance(end, SolveCancelled):  # otherwise the file is closed
                    take.discard(bpy.context)
                for left in range(index, len(self._takes)):
                    show_status(left, Status.CANCELLED)
                raise
            except (MocapAssistError, MemoryError) as error:
                n_failed += 1
                if take.was_added:
                    push_undo(take.name)  # its import stays
                show_status(index, Status.FAILED, str(error) or "Memory ran out.")
            else:
                show_status(index, Status.DONE, message, action_numbers() - before)
                push_undo(take.name)
        return _summary(len(self._takes), n_failed)


def _summary(n_takes: int, n_failed: int) -> str:
    """Return what was done, in the language of the window."""
    n_fixed = n_takes - n_failed
    message = translated(f"Fixed {n_fixed} of {n_takes} takes.")
    if not n_failed:
        return message
    failed = translated(f"{n_failed} failed: see the list.")
    return f"{message} {failed}"


def _over_sidebar(event: bpy.types.Event) -> bool:
    """Return whether the pointer is over a sidebar."""
    return any(
        area.type == "VIEW_3D"
        and region.type == "UI"
        and 0 <= event.mouse_x - region.x < region.width
        and 0 <= event.mouse_y - region.y < region.height
        for window in bpy.context.window_manager.windows
        for area in window.screen.areas
        for region in area.regions
    )
