"""What a library of clips teaches for one take: the option `--library` of other verbs."""

import argparse
from pathlib import Path

from ..denoising import FilterBasesSettings
from ..errors import InvalidSettingError
from ..files import real_path
from ..motion import JointRecording, Motion, Tracks
from ..progress import Progress
from ..retrieval import ClipLibrary, load_clip_library
from ..workflows import LibraryBases, LibraryPostures, bases_from_library, postures_from_library
from .options import settings_from_arguments


def add_library_option(parser: argparse._ActionsContainer) -> None:
    """Add the option."""
    parser.add_argument(
        "--library", type=Path, metavar="FILE",
        help="A library of clips, as the verb index makes it: each take learns from what in it"
        " is like the take",
    )  # fmt: skip


def check_library(path: Path | None) -> None:
    """Refuse what is no library, before any work is done."""
    if path is not None:
        with load_clip_library(path) as library:
            if not library.entries:
                raise InvalidSettingError(f"The library {path} has no clips; index some first.")


def bases_for(
    recording: Motion | Tracks, source: Path, arguments: argparse.Namespace, progress: Progress
) -> LibraryBases:
    """Learn from the clips that are like a take, though not from the take itself."""
    with load_clip_library(arguments.library) as library:
        return bases_from_library(
            recording,
            library,
            learning=settings_from_arguments(arguments, FilterBasesSettings),
            ignore=_itself(library, source),
            progress=progress,
        )


def postures_for(
    recording: JointRecording | Motion,
    source: Path,
    arguments: argparse.Namespace,
    progress: Progress,
) -> LibraryPostures:
    """Collect postures of the clips that are like a take, though not of the take itself."""
    with load_clip_library(arguments.library) as library:
        return postures_from_library(
            recording, library, ignore=_itself(library, source), progress=progress
        )


def _itself(library: ClipLibrary, source: Path) -> list[str]:
    path = str(real_path(source))
    return [
        entry.name
        for entry in library.entries
        if entry.origin is not None and entry.origin.path == path
    ]
