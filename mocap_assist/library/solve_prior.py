"""A library as what Clean and Reconstruct learn from: the clips that are similar to a take."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any

from ...solvers.errors import InvalidFileError
from ...solvers.motion import Motion, Tracks
from ...solvers.progress import Progress
from ...solvers.retrieval import ClipEntry, ClipLibrary, load_clip_library
from ...solvers.workflows import (
    LibraryBases,
    LibraryPostures,
    bases_from_library,
    postures_from_library,
)
from ..jobs.in_blender import BackgroundBlender
from .solve_fetching import read_origin

Own = tuple[tuple[str, str], ...]
"""Files, and actions in them."""


@dataclass(frozen=True)
class LibraryPrior:
    """A library, and the means to read its clips again."""

    path: str
    state: tuple[int, int]
    """Size and time of the file: what is learned of it holds until it changes."""
    own: Own
    """Origin of the take itself, which is left out of the examples."""
    blender: BackgroundBlender

    def bases(self, body: Motion | Tracks, progress: Progress) -> LibraryBases:
        """Learn filter bases from the clips that are similar to the body's motion."""
        with self._open_library() as (library, reading):
            return bases_from_library(body, library, progress=progress, **reading)

    def postures(self, body: Motion, progress: Progress) -> LibraryPostures:
        """Collect the postures of the clips that are similar to the body's motion."""
        with self._open_library() as (library, reading):
            return postures_from_library(body, library, progress=progress, **reading)

    @contextmanager
    def _open_library(self) -> Iterator[tuple[ClipLibrary, dict[str, Any]]]:
        with load_clip_library(self.path) as library:
            ignore = own_clips(library, self.own)
            fetch = partial(_fetch, blender=self.blender)
            yield library, {"ignore": ignore, "fetch": fetch}


def own_clips(library: ClipLibrary, own: Own) -> set[str]:
    """Return the names of the clips that come from these files and actions."""
    return {
        entry.name
        for entry in library.entries
        if entry.origin is not None and (entry.origin.path, entry.origin.item) in own
    }


def _fetch(entry: ClipEntry, blender: BackgroundBlender) -> Motion:
    if entry.origin is None:
        raise InvalidFileError(
            f"The source file of {entry.name} is unknown. Build the library again."
        )
    return read_origin(entry.origin, blender)
