"""Locations of the library and of its clips' sources."""

from pathlib import Path

import bpy

from ...solvers.errors import InvalidFileError
from ..blender.name_lists import split_names
from ..blender.path_properties import absolute
from ..jobs.in_blender import BackgroundBlender
from .button_settings import LibraryChoices
from .solve_indexing import IndexProblem, Source

EXTENSION = __package__.rsplit(".", 2)[0]
SHARED = "clips.library"


def library_path(choices: LibraryChoices) -> Path:
    """Return the library's file: the chosen one, or the shared default."""
    if choices.library_file:
        return absolute(choices.library_file)
    return Path(bpy.utils.extension_path_user(EXTENSION)) / SHARED


def asset_folders() -> tuple[str, ...]:
    """Return the folders of all asset libraries of the preferences."""
    libraries = bpy.context.preferences.filepaths.asset_libraries
    return tuple(bpy.path.abspath(each.path) for each in libraries if each.path)


def listed_sources(choices: LibraryChoices) -> tuple[Source, ...]:
    """Return the sources to index."""
    sources = [Source(str(absolute(each))) for each in split_names(choices.sources)]
    if choices.asset_libraries:
        sources += [Source(folder, assets_only=True) for folder in asset_folders()]
    return tuple(sources)


def index_problem(choices: LibraryChoices) -> IndexProblem:
    """Return the sources to index and their library, for another process.

    Raises
    ------
    InvalidFileError
        Nothing was named.
    """
    sources = listed_sources(choices)
    if not sources:
        raise InvalidFileError(
            "No sources are listed. Add folders or files, or turn on asset libraries."
        )
    tags = tuple(tag.strip() for tag in choices.tags.split(",") if tag.strip())
    library = library_path(choices)
    return IndexProblem(str(library), sources, tags, background_blender(choices.rig_file))


def background_blender(rig_file: str) -> BackgroundBlender:
    """Return this Blender as the reader of .blend files, with the rig's file, even if it is
    missing."""
    rig = str(absolute(rig_file)) if rig_file else ""
    return BackgroundBlender(str(bpy.app.binary_path), rig)
