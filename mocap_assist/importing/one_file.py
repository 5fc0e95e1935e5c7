"""Import one file while Blender runs, as the first step of a longer job."""

from collections.abc import Generator
from functools import partial
from pathlib import Path

import bpy

from ...solvers.errors import InvalidFileError, MocapAssistError
from ..jobs.job import Job
from .button_settings import ImportChoices
from .depth_folders import readable
from .recording_objects import conversion_from_choices
from .solve_reading import Read, read_files
from .transaction import ImportTransaction

Reading = Generator[tuple[float, str], None, list[Read]]


class ImportedFile:
    """A file that is read in a process of its own with the default settings of Import."""

    def __init__(self, context: bpy.types.Context, path: Path) -> None:
        self._path = path
        self._transaction = ImportTransaction(context, ImportChoices())

    def read(self, context: bpy.types.Context) -> Reading:
        """Read the file; yield the progress, and return its contents.

        Raises MocapAssistError if it cannot be read.
        """
        choices = self._transaction.choices
        path = readable(context, self._path, choices)
        conversion = conversion_from_choices(context, choices)
        job = Job(partial(read_files, [path], conversion))
        try:
            while not job.done():
                yield job.progress()
        except BaseException:
            job.cancel()
            job.tidy_up()
            raise
        (found,) = job.result()
        if isinstance(found, MocapAssistError):
            raise found
        return found

    def add(self, context: bpy.types.Context, found: list[Read]) -> bpy.types.Object:
        """Add what was read to the scene, active; raise InvalidFileError if it cannot be."""
        for content, moving in found:
            self._transaction.add(context, self._path, content, moving=moving)
        imported = self._transaction.end(context)
        if not imported.made:
            raise InvalidFileError(imported.failed[0])
        return imported.made[-1]

    def take_back(self, context: bpy.types.Context) -> None:
        """Leave the scene as it was before."""
        self._transaction.take_back(context)
