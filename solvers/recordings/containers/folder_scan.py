"""Search folders for files; unreadable entries do not stop the search."""

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from ...errors import FileAccessError
from ...faults import Failure, attempt


class _ScannedEntry(NamedTuple):
    path: Path
    is_folder: bool


def files_below(
    folder: Path, is_take: Callable[[Path], bool] = lambda folder: False
) -> Iterator[Path]:
    """Yield the files in and below a folder, by name, and folders that are one recording.

    Hidden files, hidden folders and links to folders are skipped. A folder that cannot be
    listed is yielded itself, so that its reader reports the reason (`check_folder_access`).

    Parameters
    ----------
    folder : Path
    is_take : callable
        Returns whether a folder is one recording; it is then not searched. If that fails, the
        folder is yielded and its reader reports the reason.
    """
    waiting = [_ScannedEntry(folder, is_folder=True)]
    while waiting:
        path, is_folder = waiting.pop()
        if not is_folder:
            yield path
            continue
        is_recording = attempt(path, is_take, path)
        inside = attempt(path, _entries, path)
        if is_recording or isinstance(inside, Failure):
            yield path
        else:
            waiting += reversed(inside)


def check_folder_access(folder: Path) -> None:
    """Raise FileAccessError if a folder cannot be listed."""
    try:
        with os.scandir(folder) as entries:
            for entry in entries:
                entry.stat(follow_symlinks=False)
                return
    except OSError as error:
        raise FileAccessError(
            f"The folder {folder} cannot be opened ({error.strerror}). Change its"
            " permissions, or leave it out."
        ) from None


def is_folder(path: Path) -> bool:
    """Return whether a path is a folder; False if the system refuses to answer."""
    try:
        return path.is_dir()
    except OSError:
        return False


def _entries(folder: Path) -> list[_ScannedEntry]:
    """Return the entries of a folder by name; raise OSError if it cannot be listed."""
    entries = []
    for path in sorted(folder.iterdir()):
        if path.name.startswith("."):
            continue
        if path.is_dir():
            entries += [] if path.is_symlink() else [_ScannedEntry(path, is_folder=True)]
        elif path.is_file():
            entries.append(_ScannedEntry(path, is_folder=False))
    return entries
