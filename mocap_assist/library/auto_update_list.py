"""Libraries that are indexed automatically for this user on this machine.

A .blend file cannot add to them: its library is indexed when Index is pressed, and
automatically only after *Keep Current* was pressed for exactly these sources.
"""

from pathlib import Path
from typing import Any

import bpy

from ..blender import permissions
from ..blender.name_lists import join_names
from ..jobs.in_blender import BackgroundBlender
from .button_settings import LibraryChoices
from .solve_indexing import IndexProblem, Source
from .sources import index_problem, library_path, listed_sources


def auto_updated_libraries() -> list[IndexProblem]:
    """Return the libraries that are kept current."""
    stored = permissions.permissions_of(permissions.LIBRARIES)
    return [kept for each in stored if (kept := _problem_from_stored(each)) is not None]


def is_kept(problem: IndexProblem) -> bool:
    """Whether a library is kept current from exactly these sources."""
    return problem in auto_updated_libraries()


def keep_updated(problem: IndexProblem) -> None:
    """Update a library automatically from these sources, which replace earlier ones."""
    permissions.replace_permissions(
        permissions.LIBRARIES,
        [*_stored_without(problem.library), _stored_from_problem(problem)],
    )


def stop_keeping(library: str) -> None:
    """Index a library only when Index is pressed."""
    permissions.replace_permissions(permissions.LIBRARIES, _stored_without(library))


def toggle_kept(choices: LibraryChoices) -> str:
    """Keep a library current from these sources, or no longer; return a sentence about it.

    Raises
    ------
    InvalidFileError
        No source is listed, or the permission cannot be stored.
    """
    problem = index_problem(choices)
    name = Path(problem.library).name
    if is_kept(problem):
        stop_keeping(problem.library)
        return f"{name} is updated only when you press Build Library."
    keep_updated(problem)
    if len(problem.sources) == 1:
        return f"{name} is updated automatically from 1 source."
    return f"{name} is updated automatically from {len(problem.sources)} sources."


def change_sources(library: Any, sources: list[str]) -> None:
    """Let the sidebar list other sources; a library that is kept from them stays so.

    Parameters
    ----------
    library : the sidebar's settings of the library
    sources : paths of files and folders
    """
    was_kept = choices_are_kept(library.settings().choices)
    library.sources = join_names(sources)
    choices = library.settings().choices
    if was_kept and listed_sources(choices):
        keep_updated(index_problem(choices))
    elif was_kept:
        stop_keeping(str(library_path(choices)))


def choices_are_kept(choices: LibraryChoices) -> bool:
    """Whether the library of these choices is kept current from their sources."""
    return bool(listed_sources(choices)) and is_kept(index_problem(choices))


def _stored_without(library: str) -> list[Any]:
    return [
        _stored_from_problem(each)
        for each in auto_updated_libraries()
        if each.library != library
    ]


def _stored_from_problem(problem: IndexProblem) -> dict[str, Any]:
    return {
        "library": problem.library,
        "places": [[source.path, source.assets_only] for source in problem.sources],
        "tags": list(problem.tags),
        "rig": problem.blender.rig,
    }


def _problem_from_stored(stored: Any) -> IndexProblem | None:
    """Undo `_stored_from_problem`; None for what this version does not understand."""
    try:
        sources = tuple(Source(str(path), bool(assets)) for path, assets in stored["places"])
        tags = tuple(map(str, stored["tags"]))
        blender = BackgroundBlender(str(bpy.app.binary_path), str(stored["rig"]))
        return IndexProblem(str(stored["library"]), sources, tags, blender)
    except (TypeError, ValueError, KeyError):
        return None
