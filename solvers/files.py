"""Write files whole or not at all, and open nothing but files."""

import errno
import os
import re
import stat
import struct
import zipfile
import zlib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from secrets import token_hex
from tokenize import TokenError
from typing import BinaryIO

from .errors import FileAccessError, InvalidFileError

# What numpy and zipfile were seen to raise on files that are cut short or altered.
DAMAGE = (
    OSError, ValueError, EOFError, IndexError, KeyError, AttributeError, TypeError,
    NotImplementedError, OverflowError, RecursionError, SyntaxError, TokenError,
    zipfile.BadZipFile, zlib.error, struct.error,
)  # fmt: skip


DISK_FULL = {errno.ENOSPC, errno.EDQUOT}
PART_BYTES = 6
"""Random bytes in the name of a temporary file, so that two writers do not meet."""


def reason_of(error: OSError) -> str:
    """Return what the system reports, in words that say what to do about a full disk."""
    if error.errno in DISK_FULL:
        return "the disk is full"
    return error.strerror or str(error)


def unreadable(path: Path | str, error: OSError) -> FileAccessError:
    """Return the error of a file or folder that the system does not let us read."""
    return FileAccessError(f"{path} cannot be read ({reason_of(error)}).")


def real_path(path: Path | str) -> Path:
    """Return a path that is absolute and without links; a link to itself stays."""
    return Path(os.path.realpath(path))


def is_missing(path: Path | str) -> bool:
    """Whether there is no such file or folder; where the system does not say, there may be."""
    try:
        Path(path).stat()
    except (FileNotFoundError, NotADirectoryError):
        return True
    except (OSError, ValueError):
        return False
    return False


def open_regular(path: Path | str) -> BinaryIO:
    """Open a file to be read.

    Raises OSError for what is none: a pipe would be waited for, a device may never end.
    """
    ways = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    descriptor = os.open(path, ways)
    try:
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            raise OSError(errno.EINVAL, "it is not a file", str(path))
        return os.fdopen(descriptor, "rb")
    except BaseException:
        os.close(descriptor)
        raise


@contextmanager
def write_atomically(path: Path | str) -> Iterator[Path]:
    """Yield a temporary path beside `path`; move it onto `path` if all goes well.

    On any exception the temporary file is removed and `path` is as it was. The content is on
    the disk before the move: after a loss of power `path` holds the old content or the new.

    Raises
    ------
    InvalidFileError
        The folder is missing or may not be written to, or the disk is full.
    """
    path = Path(path)
    part = path.with_name(f"{_part_stem(path)}{token_hex(PART_BYTES)}{path.suffix}")
    try:
        try:  # Not tempfile's: a Ctrl-C that falls into it leaves its file behind, or is lost.
            yield part
            with part.open("rb+") as file:
                os.fsync(file.fileno())
            part.replace(path)
        finally:
            part.unlink(missing_ok=True)
    except OSError as error:
        raise InvalidFileError(f"{path} cannot be written: {reason_of(error)}.") from None


def remove_leftovers(paths: Iterable[Path]) -> None:
    """Remove the temporary files of `write_atomically` for these paths.

    Only a process that was killed, or a computer that lost its power, leaves any. Nobody else
    may be writing these paths.
    """
    in_folders: dict[Path, list[Path]] = {}
    for path in paths:
        in_folders.setdefault(path.parent, []).append(path)
    for folder, here in in_folders.items():
        starts = {(_part_stem(path), path.suffix) for path in here}
        for file in folder.glob(".*") if folder.is_dir() else ():
            stem, n_digits = file.stem, 2 * PART_BYTES
            is_part = re.fullmatch(r"[0-9a-f]+", stem[-n_digits:]) is not None
            if is_part and (stem[:-n_digits], file.suffix) in starts:
                file.unlink(missing_ok=True)


def _part_stem(path: Path) -> str:
    return f".{path.stem[:40]}."
