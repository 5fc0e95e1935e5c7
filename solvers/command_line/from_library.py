"""The option `--library`: priors from similar clips of a library.

What searches a library takes long to import, so that a command without the option does not.
"""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from ..denoising import FilterBasesSettings
from ..errors import InvalidSettingError
from ..files import real_path
from ..motion import JointRecording, Motion, Tracks
from ..progress import Progress
from .arguments import settings_from_arguments

if TYPE_CHECKING:
    from ..retrieval import ClipLibrary
    from ..workflows import LibraryBases, LibraryPostures


def add_library_option(parser: argparse._ActionsContainer) -> None:
    """Add the option."""
    parser.add_argument(
        "--library", type=Path, metavar="FILE",
        help="A clip library, made by the verb index; each take uses the clips that are similar"
        " to it",
    )  # fmt: skip


def check_library(path: Path | None) -> None:
    """Raise an error if the library is missing or empty, before any work."""
    if path is not None:
        from ..retrieval import load_clip_library

        with load_clip_library(path) as library:
            if not library.entries:
                raise InvalidSettingError(f"The library {path} has no clips; index some first.")


def learn_bases(
    recording: Motion | Tracks, source: Path, arguments: argparse.Namespace, progress: Progress
) -> "LibraryBases":
    """Learn bases from the clips similar to a take, except the take itself."""
    from ..retrieval import load_clip_library
    from ..workflows import bases_from_library

    with load_clip_library(arguments.library) as library:
        return bases_from_library(
            recording,
            library,
            learning=settings_from_arguments(arguments, FilterBasesSettings),
            ignore=_own_clips(library, source),
            progress=progress,
        )


def collect_postures(
    recording: JointRecording | Motion,
    source: Path,
    arguments: argparse.Namespace,
    progress: Progress,
) -> "LibraryPostures":
    """Collect postures from the clips similar to a take, except the take itself."""
    from ..retrieval import load_clip_library
    from ..workflows import postures_from_library

    with load_clip_library(arguments.library) as library:
        return postures_from_library(
            recording, library, ignore=_own_clips(library, source), progress=progress
        )


def _own_clips(library: "ClipLibrary", source: Path) -> list[str]:
    path = str(real_path(source))
    return [
        entry.name
        for entry in library.entries
        if entry.origin is not None and entry.origin.path == path
    ]
