"""What this user has allowed on this machine: no .blend file can bring any of it along.

It is kept in a file of the extension's own folder, so that what is automatic (timers, handlers
of loaded files) never acts on what a .blend file says alone. A press is a permission for what
was pressed, and needs none of these.
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
"""Of each kind; the oldest are forgotten first."""


def allow_recording(path: str) -> None:
    """Let a depth recording be opened whenever a .blend file shows it."""
    name = _name(path)
    change(RECORDINGS, [*[each for each in entries(RECORDINGS) if each != name], name])


def recording_allowed(path: str) -> bool:
    """Whether this user has imported or shown the recording on this machine before."""
    return _name(path) in entries(RECORDINGS)


def entries(kind: str) -> list[Any]:
    """Return what is allowed of a kind; nothing where the file is missing or damaged."""
    path = _file()
    try:
        stored = _read(path, path.stat().st_mtime_ns).get(kind, [])
    except OSError:
        return []
    return stored if isinstance(stored, list) else []


def change(kind: str, allowed: list[Any]) -> None:
    """Allow these of a kind, and no others.

    Raises
    ------
    InvalidFileError
        The extension's folder cannot be written to.
    """
    path = _file()
    stored = {each: entries(each) for each in (RECORDINGS, LIBRARIES)}
    stored[kind] = allowed[-MAX_ENTRIES:]
    bpy.utils.extension_path_user(EXTENSION, create=True)
    with write_atomically(path) as part:
        part.write_text(json.dumps(stored, indent=1), encoding="utf-8")
    _read.cache_clear()  # Two changes may come within one tick of the file system's clock.


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
    """Return a path as it is compared, without looking at the disk or a network."""
    return os.path.normcase(os.path.normpath(absolute(path).absolute()))
