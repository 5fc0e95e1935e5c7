"""Takes that Fix My Take works on one after another, and their status in the sidebar."""

from collections.abc import Collection, Generator, Sequence
from enum import Enum
from pathlib import Path
from typing import Protocol

import bpy
from bpy.app import handlers

from ...solvers.errors import InvalidFileError, InvalidMotionError
from ..actions.markers.holders import holder_of
from ..depth.depth_preview import shows_depth
from ..importing.depth_folders import all_recordings_in
from ..importing.one_file import ImportedFile
from ..runtime.subject import Subject

QUEUE = "mocap_assist_queue"
"""Property of the window manager with the list."""
NOTHING = "Select animated armatures, markers or the points of depth recordings."
Bringing = Generator[tuple[float, str], None, Subject]


class Status(Enum):
    """State of a take; its value is the label in the list."""

    WAITING = "Waiting"
    RUNNING = "Running"
    DONE = "Fixed"
    REMOVED = "Removed"
    FAILED = "Failed"
    CANCELLED = "Cancelled"


ICONS = {
    Status.WAITING: "TIME",
    Status.RUNNING: "PLAY",
    Status.DONE: "CHECKMARK",
    Status.REMOVED: "LOOP_BACK",
    Status.FAILED: "ERROR",
    Status.CANCELLED: "X",
}


class QueuedTake(Protocol):
    """A take that waits."""

    @property
    def name(self) -> str:
        """Name in the list."""

    def bring(self, context: bpy.types.Context) -> Bringing:
        """Bring the take into the scene if it is not there; yield the progress."""

    def discard(self, context: bpy.types.Context) -> None:
        """Remove from the scene what `bring` has added."""

    @property
    def was_added(self) -> bool:
        """Whether `bring` has added the take to the scene."""


class TakeOfScene:
    """A take that is in the scene."""

    def __init__(self, scene: bpy.types.Scene, subject: bpy.types.Object) -> None:
        self.name, self._subject = subject.name, Subject.of(scene, subject)

    def bring(self, context: bpy.types.Context) -> Bringing:
        """Return the subject."""
        yield from ()
        return self._subject

    def discard(self, context: bpy.types.Context) -> None:
        """Do nothing: it was there before."""

    @property
    def was_added(self) -> bool:
        """False: it was there before."""
        return False


class TakeOfFile:
    """A take that is in a file."""

    def __init__(self, path: Path) -> None:
        self.name, self._path = path.name, path
        self._file: ImportedFile | None = None
        self.was_added = False

    def bring(self, context: bpy.types.Context) -> Bringing:
        """Import the file."""
        self._file = ImportedFile(context, self._path)
        found = yield from self._file.read(context)
        subject = Subject.of(context.scene, self._file.add(context, found))
        self.was_added = True
        return subject

    def discard(self, context: bpy.types.Context) -> None:
        """Leave the scene as it was before the import."""
        if self._file is not None:
            self._file.take_back(context)


def selected_takes(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Return the selected armatures, parents of markers and points of depth images."""
    found = []
    for each in context.view_layer.objects.selected:
        if each.type == "ARMATURE" or shows_depth(each):
            found.append(each)
        elif (holder := holder_of(each)) is not None:
            found.append(holder)
    return list(dict.fromkeys(found))


def takes_of(context: bpy.types.Context, folder: Path | None) -> list[QueuedTake]:
    """Return the takes of a folder, or those that are selected.

    Raises MocapAssistError if there are none.
    """
    if folder is None:
        if not (chosen := selected_takes(context)):
            raise InvalidMotionError(NOTHING)
        return [TakeOfScene(context.scene, each) for each in chosen]
    paths = all_recordings_in(folder)
    if not paths:
        raise InvalidFileError(f"There is no recording in the folder {folder}.")
    return [TakeOfFile(path) for path in paths]


def show_takes(takes: Sequence[QueuedTake]) -> None:
    """List the takes in the sidebar, all waiting."""
    queue = shown_queue()
    queue.takes.clear()
    queue.paused = False
    for take in takes:
        row = queue.takes.add()
        row.name = take.name
    for index in range(len(takes)):
        show_status(index, Status.WAITING)


def show_status(
    index: int, status: Status, note: str = "", results: Collection[int] = ()
) -> None:
    """Show the status of a take, a sentence about it, and keep the numbers of its actions."""
    row = shown_queue().takes[index]
    row.status, row.note = status.name, note
    row.results = " ".join(map(str, results))


def action_numbers() -> set[int]:
    """Return the numbers of all actions; in a session they survive undo."""
    return {each.session_uid for each in bpy.data.actions}


@handlers.persistent
def renew_statuses(*_: object) -> None:
    """Show whether the results of fixed takes are still there."""
    here = {str(number) for number in action_numbers()}
    for row in shown_queue().takes:
        if row.status in {Status.DONE.name, Status.REMOVED.name}:
            is_here = here.issuperset(row.results.split())
            row.status = (Status.DONE if is_here else Status.REMOVED).name


def shown_queue() -> bpy.types.PropertyGroup:
    """Return the list of the sidebar."""
    return getattr(bpy.context.window_manager, QUEUE)


def register() -> None:
    """Renew the statuses at each undo and redo."""
    for steps in (handlers.undo_post, handlers.redo_post):
        steps.append(renew_statuses)


def unregister() -> None:
    """Remove the handlers."""
    for steps in (handlers.undo_post, handlers.redo_post):
        steps.remove(renew_statuses)
