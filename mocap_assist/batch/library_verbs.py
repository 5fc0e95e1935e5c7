"""`index` and `find`: the buttons of the library as verbs."""

import argparse
import json
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import bpy

from ...solvers.command_line.batches import Screen, printable
from ...solvers.errors import InvalidFileError
from ...solvers.files import real_path, write_atomically
from ...solvers.progress import Progress
from ..find_similar import searches
from ..find_similar.scene_finding import list_found, read_finding
from ..find_similar.solve_finding import Found
from ..library.background import message_of
from ..library.button_settings import FindBundle, LibraryChoices
from ..library.solve_indexing import IndexProblem, Source, index_sources
from ..library.sources import asset_folders, background_blender, library_path
from .bundles import add_bundle_options, bundle_from_arguments
from .saving import STDOUT
from .solving import solve_in_subprocess

INDEX_HELP = "Add the clips of recordings, .blend files and asset libraries to a library."
FIND_HELP = "List library clips similar to the current motion of armatures or markers."
VerbResult = tuple[str, dict[str, Any]]


def add_index_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `index`."""
    parser.add_argument(
        "sources", nargs="*", type=Path, metavar="FILE",
        help="recordings, .blend files and folders of them",
    )  # fmt: skip
    _add_library(parser)
    parser.add_argument(
        "--asset-libraries", action="store_true",
        help="also index the action assets of all asset libraries in the preferences",
    )  # fmt: skip
    parser.add_argument(
        "--rig", default="", metavar="FILE",
        help=".blend file with the rig for actions stored without one",
    )  # fmt: skip
    parser.add_argument("--tag", action="append", default=[], help="a tag for these clips")
    parser.add_argument(
        "--json", nargs="?", type=Path, const=STDOUT, metavar="FILE",
        help="write one line of JSON to FILE; without FILE print it",
    )  # fmt: skip


def perform_index(arguments: argparse.Namespace, screen: Screen) -> None:
    """Update a library, and report the files that cannot be indexed.

    Raises
    ------
    InvalidFileError
        Something could not be read, or nothing was named.
    """
    sources = [Source(str(real_path(path))) for path in arguments.sources]
    if arguments.asset_libraries:
        sources += [Source(folder, assets_only=True) for folder in asset_folders()]
    if not sources:
        raise InvalidFileError("No sources given: name files or folders to index.")
    path = library_path(LibraryChoices(library_file=arguments.library))
    screen.title = "Index"
    blender = background_blender(arguments.rig)
    problem = IndexProblem(str(path), tuple(sources), tuple(arguments.tag), blender)
    indexed = solve_in_subprocess(partial(index_sources, problem), arguments, screen.progress)
    screen.clear()
    figures = {
        "library": str(path),
        "n_clips": indexed.n_clips,
        "read": indexed.n_added,
        "unchanged": indexed.n_kept,
        "removed": indexed.n_removed,
        "refused": list(indexed.refused),
    }
    sys.stdout.write(
        (json.dumps(figures) if arguments.json == STDOUT else printable(message_of(indexed)))
        + "\n"
    )
    sys.stdout.flush()
    if arguments.json not in {None, STDOUT}:
        with write_atomically(arguments.json) as part:
            part.write_text(json.dumps(figures) + "\n", encoding="utf-8")
    if indexed.refused:
        raise InvalidFileError(" ".join(indexed.refused))


def add_find_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `find`; those of the button, and the library."""
    _add_library(parser)
    add_bundle_options(parser, FindBundle)


def check_find(arguments: argparse.Namespace, subjects: Sequence[bpy.types.Object]) -> None:
    """Raise InvalidFileError where there is no library."""
    path = library_path(LibraryChoices(library_file=arguments.library))
    if not path.is_file():
        raise InvalidFileError(f"There is no clip library {path}. Make one with index.")


def perform_find(
    scene: bpy.types.Scene,
    subject: bpy.types.Object,
    arguments: argparse.Namespace,
    progress: Progress,
) -> VerbResult:
    """Search for the current motion of the armature or the markers."""
    settings = bundle_from_arguments(arguments, FindBundle)
    scene.mocap_assist.library.library_file = arguments.library
    finding = solve_in_subprocess(read_finding(scene, subject, settings), arguments, progress)
    sentence = list_found(scene, subject, settings, finding)
    search = searches.listed_search(bpy.context)
    found = search.finding.found if search is not None else ()
    figures = {"matches": [_figures(each) for each in found]}
    return "\n".join([sentence, *map(_row, found)]), figures


def _row(found: Found) -> str:
    frames = found.match.frames
    return f"{found.match.score:5.0%}  {frames.start + 1}-{frames.stop}  {found.entry.name}"


def _figures(found: Found) -> dict[str, Any]:
    origin, frames = found.entry.origin, found.match.frames
    return {
        "clip": found.entry.name,
        "score": found.match.score,
        "first_frame": frames.start,
        "last_frame": frames.stop - 1,
        "frame_rate_hz": found.entry.frame_rate,
        "tags": list(found.entry.tags),
        "path": origin.path if origin else None,
        "item": origin.item if origin else None,
    }


def _add_library(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--library", default="", metavar="FILE",
        help="the library [default: the one that all files share]",
    )  # fmt: skip
