"""Locks on files that end with the process that holds them, even if it is killed."""

import errno
import os
import sys
from contextlib import suppress
from pathlib import Path

if sys.platform == "win32":
    import msvcrt

    def _lock(file: int) -> None:
        msvcrt.locking(file, msvcrt.LK_NBLCK, 1)

else:
    import fcntl

    def _lock(file: int) -> None:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


HELD_ERRORS = {errno.EACCES, errno.EAGAIN, errno.EDEADLK}
"""Error codes of systems for a lock that another process holds."""


class FileLock:
    """A lock that this process holds; made by `try_lock`. Its file exists until `release`."""

    def __init__(self, path: Path, file: int) -> None:
        self._path, self._file = path, file

    def release(self) -> None:
        """Remove the file and let go of the lock."""
        if sys.platform == "win32":  # an open file cannot be removed there
            os.close(self._file)
            with suppress(OSError):
                self._path.unlink()
        else:  # while it is locked, so that no other process's file is removed
            self._path.unlink(missing_ok=True)
            os.close(self._file)


def try_lock(path: Path, *, create: bool = True) -> FileLock | None:
    """Return the lock on a file, or None while another process, or this one, holds it.

    Parameters
    ----------
    path : Path
        A file for nothing but this lock.
    create : bool
        Whether the file is made where there is none.

    Raises
    ------
    OSError
        The file is missing, cannot be opened or made, or its file system has no locks.
    """
    flags = os.O_RDWR | (os.O_CREAT if create else 0)
    flags |= getattr(os, "O_NOFOLLOW", 0)
    while True:
        file = os.open(path, flags, 0o600)
        kept = False
        try:
            _lock(file)
            # Its last holder may have removed the file between the two lines before.
            with suppress(FileNotFoundError):
                kept = os.path.samestat(os.fstat(file), path.stat(follow_symlinks=False))
        except OSError as error:
            if error.errno in HELD_ERRORS:
                return None
            raise
        finally:
            if not kept:
                os.close(file)
        if kept:
            return FileLock(path, file)
