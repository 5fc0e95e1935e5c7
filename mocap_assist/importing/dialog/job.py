"""Read files in a process of its own, and add them to the scene one by one."""

from collections import deque
from functools import partial
from pathlib import Path

import bpy

from ....solvers.errors import InvalidFileError, MocapAssistError, OutOfMemoryError
from ....solvers.faults import Failure, attempt
from ...jobs.batches import batches_by_size
from ...jobs.job import Job, ProcessDied
from ...runtime.watch import Watch
from ..button_settings import ImportChoices
from ..depth_folders import readable
from ..recent_files import State, reading_of, state_of, store_read_file
from ..recording_objects import conversion_from_choices
from ..solve_reading import Read, read_files
from ..transaction import READING_FRACTION, ImportTransaction

BYTES_AT_ONCE = 64_000_000
"""Bytes of files that are read before their content is added to the scene."""


class ImportJob:
    """One import; `step` is called repeatedly, and each call works briefly.

    Parameters
    ----------
    context : bpy.types.Context
        With a window, whose status bar shows the progress.
    paths : files, at least one
    choices : ImportChoices
    """

    def __init__(
        self, context: bpy.types.Context, paths: list[Path], choices: ImportChoices
    ) -> None:
        self.transaction = ImportTransaction(context, choices)
        paths = self._readable(context, paths, choices)
        self._wanted = conversion_from_choices(context, self.transaction.choices)
        self._batches = deque(batches_by_size(paths, _size, BYTES_AT_ONCE))
        self._n_files, self._n_read, self._n_in = len(paths), 0, 0
        self._shown = 0.0
        self._states: list[State] = []
        self._read: deque[tuple[Path, State, list[Read] | MocapAssistError]] = deque()
        self.job: Job[list[list[Read] | MocapAssistError]] = Job(self._next_batch())
        self.watch = Watch(context, "import", self._stop)
        self._show(context)

    def step(self, context: bpy.types.Context) -> bool:
        """Work briefly; return whether the import and its display have ended."""
        if self._read:
            self._bring_in(context, *self._read.popleft())
            self._n_in += 1
        elif self.job.done():
            self._fetch()
        if not (self._read or self._batches or self._n_in < self._n_files):
            self.watch.end(context)
            return True
        self._show(context)
        return False

    def cancel(self, context: bpy.types.Context) -> None:
        """Stop at once and leave the scene as it was."""
        self.watch.abandon(context)
        self.transaction.take_back(context)

    def _stop(self) -> None:
        self.job.cancel()
        self.job.tidy_up()

    def _readable(
        self, context: bpy.types.Context, paths: list[Path], choices: ImportChoices
    ) -> list[Path]:
        """Return the files that another process can read; refuse the rest, and raise if none is
        left."""
        found = [attempt(path, readable, context, path, choices) for path in paths]
        failed = [each for each in found if isinstance(each, Failure)]
        if len(failed) == len(paths):
            raise failed[0].as_error()
        for path, each in zip(paths, found, strict=True):
            if isinstance(each, Failure):
                self.transaction.refuse(path, each.as_error())
        return [each for each in found if isinstance(each, Path)]

    def _next_batch(self) -> "partial[list[list[Read] | MocapAssistError]]":
        self._states = [state_of(path) for path in self._batches[0]]
        return partial(read_files, self._batches[0], self._wanted)

    def _fetch(self) -> None:
        """Take over what was read, and let the next files be read meanwhile.

        A process that died does not report at which file: each half of them is read again,
        until the damaged file is alone.
        """
        paths = self._batches.popleft()
        try:
            found = self.job.result()
        except (ProcessDied, OutOfMemoryError) as error:
            if half := len(paths) // 2:
                self._batches.extendleft([paths[half:], paths[:half]])
            found = [] if half else [_refusal(paths[0], error)]
        if found:
            self._read.extend(zip(paths, self._states, found, strict=True))
            self._n_read += len(paths)
        if self._batches:
            self.job = Job(self._next_batch())

    def _bring_in(
        self,
        context: bpy.types.Context,
        path: Path,
        state: State,
        found: list[Read] | MocapAssistError,
    ) -> None:
        if isinstance(found, MocapAssistError):
            self.transaction.refuse(path, found)
            return
        store_read_file(path, state, [take.content for take in found], reading_of(self._wanted))
        for content, moving in found:
            self.transaction.add(context, path, content, moving=moving)

    def _show(self, context: bpy.types.Context) -> None:
        fraction, message = 0.0, ""
        if self._batches:
            fraction, message = self.job.progress()
            fraction *= len(self._batches[0])
        if self._read:
            message = f"Importing {self._read[0][0].name}"
        reading = READING_FRACTION * (self._n_read + fraction)
        done = (reading + (1.0 - READING_FRACTION) * self._n_in) / self._n_files
        self._shown = max(self._shown, done)  # less is done where files are read once more
        self.watch.show(context, self._shown, message)


def _size(path: Path) -> int:
    return path.stat().st_size if path.is_file() else 0


def _refusal(path: Path, error: ProcessDied | OutOfMemoryError) -> MocapAssistError:
    """Return the error that names the file that could not be read."""
    if isinstance(error, OutOfMemoryError):
        return InvalidFileError(f"{path} does not fit into memory. Import a part of the take.")
    return InvalidFileError(
        f"Reading {path} crashed: {error.cause}. Import a part of the take, or export it"
        f" again.{error.last_output}"
    )
