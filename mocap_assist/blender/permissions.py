"""Permissions of this user on this machine; a .blend file cannot grant them.

They are stored in the extension's own folder. Automatic code (timers, load handlers) therefore
never acts on the content of a .blend file alone. A press of a button needs no permission.
"""

import json
import os
from functools import lru_cache
from pathlib import Path
from typing import Any

import bpy

from ...solvers.files import write_atomically
from ...solvers.json_text import parse_json
from .path_properties import absolute

EXTENSION = __package__.rsplit(".", 2)[0]
NAME = "permissions.json"
RECORDINGS, LIBRARIES = "depth_recordings", "kept_libraries"
MAX_ENTRIES = 1000
"""Entries per kind; the oldest are dropped first."""


def allow_recording(path: str) -> None:
    """Allow a depth recording to be opened by every .blend file that shows it."""
    name = _name(path)
    replace_permissions(
        RECORDINGS, [*[each for each in permissions_of(RECORDINGS) if each != name], name]
    )


def recording_allowed(path: str) -> bool:
    """Whether this user has imported or shown the recording on this machine before."""
    return _name(path) in permissions_of(RECORDINGS)


def permissions_of(kind: str) -> list[Any]:
    """Return the permissions of a kind; none if the file is missing or damaged."""
    path = _file()
    try:
        stored = _read(path, path.stat().st_mtime_ns).get(kind, [])
    except OSError:
        return []
    return stored if isinstance(stored, list) else []


def replace_permissions(kind: str, allowed: list[Any]) -> None:
    """Replace the permissions of a kind.

    Raises
    ------
    InvalidFileError
        The extension's folder cannot be written to.
    """
    path = _file()
    stored = {each: permissions_of(each) for each in (RECORDINGS, LIBRARIES)}
    stored[kind] = allowed[-MAX_ENTRIES:]
    bpy.utils.extension_path_user(EXTENSION, create=True)
    with write_atomically(path) as temporary:
        temporary.write_text(json.dumps(stored, indent=1), encoding="utf-8")
    _read.cache_clear()  # Two changes may share one time stamp of the file system.


def _file() -> Path:
    return Path(bpy.utils.extension_path_user(EXTENSION)) / NAME


@lru_cache(maxsize=1)
def _read(path: Path, modified: int) -> dict[str, Any]:
    try:
        stored = parse_json(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return stored if isinstance(stored, dict) else {}


def _name(path: str) -> str:
    """Return a path normalized for comparison, without access to disk or network."""
    return os.path.normcase(os.path.normpath(absolute(path).absolute()))
