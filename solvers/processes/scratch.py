"""Folders for temporary files that do not outlive their process for long.

Each has a lock file next to it that the operating system releases when its owner ends. A later
process removes folders whose lock is free: those of processes that were killed.
"""

import os
import shutil
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from hashlib import sha256
from pathlib import Path
from secrets import token_hex
from tempfile import gettempdir
from types import TracebackType
from typing import Self
from weakref import finalize

from ..errors import InvalidFileError
from ..files import real_path, reason_of
from .locks import FileLock, try_lock

PREFIX = "mocap_assist_"
LOCK = ".lock"
NAME_BYTES = 8


class ScratchFolder:
    """A new, private folder among the temporary files, as `path`; removed at the end.

    The first one of a process also clears what killed processes have left.

    Raises
    ------
    InvalidFileError
        The folder cannot be made, such as on a full disk.
    """

    def __init__(self) -> None:
        try:
            parent = Path(gettempdir())
            _clear_once(parent)
            self.path, lock = _new_folder(parent)
        except OSError as error:
            where = f" in {Path(error.filename).parent}" if error.filename else ""
            raise InvalidFileError(
                f"Temporary files cannot be written{where}: {reason_of(error)}."
                " Make room there."
            ) from None
        self._remove: Callable[[], object] = finalize(self, _remove, self.path, lock)

    def remove(self) -> None:
        """Remove the folder and all in it."""
        self._remove()

    def __enter__(self) -> Self:
        """Return itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Remove it."""
        self.remove()


def clear_abandoned(parent: Path) -> None:
    """Remove scratch folders and locks of this user in `parent` whose owners have ended."""
    for path in parent.glob(f"{PREFIX}*{LOCK}"):
        with suppress(OSError):
            if _is_own(path) and (lock := try_lock(path, create=False)) is not None:
                _remove(path.with_suffix(""), lock)


def remove_orphaned(folder: Path) -> None:
    """Remove a scratch folder whose owner has ended, from a process that worked in it."""
    shutil.rmtree(folder, ignore_errors=True)
    _lock_of(folder).unlink(missing_ok=True)


def lock_for_work_on(target: Path) -> Path:
    """Return the file that is locked while a process of this user makes `target`."""
    user = os.getuid() if hasattr(os, "getuid") else 0
    name = sha256(f"{user} {real_path(target)}".encode("utf-8", "surrogateescape"))
    return Path(gettempdir()) / f"{PREFIX}{name.hexdigest()[: 2 * NAME_BYTES]}{LOCK}"


@cache
def _clear_once(parent: Path) -> None:
    clear_abandoned(parent)


def _new_folder(parent: Path) -> tuple[Path, FileLock]:
    """Make a folder, locked before it exists, so that it never looks abandoned."""
    lock = None
    while lock is None:  # another process that clears may hold a new one for a moment
        folder = parent / f"{PREFIX}{token_hex(NAME_BYTES)}"
        lock = try_lock(_lock_of(folder))
    try:
        folder.mkdir(mode=0o700)
    except OSError:
        lock.release()
        raise
    return folder, lock


def _lock_of(folder: Path) -> Path:
    return folder.with_name(folder.name + LOCK)


def _remove(folder: Path, lock: FileLock) -> None:
    # On Windows a file that is still open cannot be removed; that is no reason to fail.
    shutil.rmtree(folder, ignore_errors=True)
    lock.release()


def _is_own(path: Path) -> bool:
    return not hasattr(os, "getuid") or path.stat(follow_symlinks=False).st_uid == os.getuid()
