"""Look through folders for files; nothing that lies in them stops the search."""

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from ...errors import FileAccessError
from ...faults import Failure, attempt


class _Entry(NamedTuple):
    path: Path
    is_folder: bool


def files_below(
    folder: Path, is_take: Callable[[Path], bool] = lambda folder: False
) -> Iterator[Path]:
    """Yield the files in a folder and below, by name, and folders that are one recording.

    Hidden files and folders are passed over, and links to folders. A folder that cannot be
    looked into is yielded itself, so that whoever reads it says why (`check_folder_access`).

    Parameters
    ----------
    folder : Path
    is_take : callable
        Returns whether a folder is one recording; it is then not looked into. If that fails,
        whoever reads it says why.
    """
    waiting = [_Entry(folder, is_folder=True)]
    while waiting:
        path, is_folder = waiting.pop()
        if not is_folder:
            yield path
            continue
        taken = attempt(path, is_take, path)
        inside = attempt(path, _entries, path)
        if taken or isinstance(inside, Failure):
            yield path
        else:
            waiting += reversed(inside)


def check_folder_access(folder: Path) -> None:
    """Raise FileAccessError where a folder cannot be looked into."""
    try:
        with os.scandir(folder) as entries:
            for entry in entries:
                entry.stat(follow_symlinks=False)
                return
    except OSError as error:
        raise FileAccessError(
            f"The folder {folder} cannot be looked into ({error.strerror}). Change its"
            " permissions, or leave it out."
        ) from None


def is_folder(path: Path) -> bool:
    """Whether a path is a folder; not where the system does not say."""
    try:
        return path.is_dir()
    except OSError:
        return False


def _entries(folder: Path) -> list[_Entry]:
    """Return what a folder holds, by name; raises OSError where that cannot be seen."""
    found = []
    for path in sorted(folder.iterdir()):
        if path.name.startswith("."):
            continue
        if path.is_dir():
            found += [] if path.is_symlink() else [_Entry(path, is_folder=True)]
        elif path.is_file():
            found.append(_Entry(path, is_folder=False))
    return found
