"""Write files atomically, and open only regular files."""

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

from .errors import FileAccessError

# Errors that numpy and zipfile raise on truncated or altered files.
DAMAGE = (
    OSError, ValueError, EOFError, IndexError, KeyError, AttributeError, TypeError,
    NotImplementedError, OverflowError, RecursionError, SyntaxError, TokenError,
    zipfile.BadZipFile, zlib.error, struct.error,
)  # fmt: skip


DISK_FULL = {errno.ENOSPC, errno.EDQUOT}
PART_BYTES = 6
"""Random bytes in the name of a temporary file, so that two writers do not collide."""


def reason_of(error: OSError) -> str:
    """Return the reason of a system error, with a plain text for a full disk."""
    if error.errno in DISK_FULL:
        return "the disk is full"
    return error.strerror or str(error)


def unreadable_error(path: Path | str, error: OSError) -> FileAccessError:
    """Return the error for a file or folder that the system does not allow to read."""
    return FileAccessError(f"{path} cannot be read ({reason_of(error)}).")


def unwritable_error(path: Path | str, error: OSError) -> FileAccessError:
    """Return the error for a file or folder that the system does not allow to write."""
    return FileAccessError(f"{path} cannot be written: {reason_of(error)}.")


def real_path(path: Path | str) -> Path:
    """Return an absolute path with resolved links; a link to itself stays."""
    return Path(os.path.realpath(path))


def is_missing(path: Path | str) -> bool:
    """Return whether a file or folder is known not to exist."""
    try:
        Path(path).stat()
    except (FileNotFoundError, NotADirectoryError):
        return True
    except (OSError, ValueError):
        return False
    return False


def make_folder(path: Path, below: Path) -> None:
    """Create a folder and those that lead to it below another one.

    `below` must exist. If it has vanished, such as with its share, it is not made again.
    """
    inner = path.relative_to(below)
    for each in [*reversed(inner.parents[:-1]), inner]:
        (below / each).mkdir(exist_ok=True)


def path_fault(path: Path | str) -> str:
    """Return why a library cannot store a path; empty if it can."""
    try:
        str(path).encode("utf-8")
    except UnicodeEncodeError:  # Linux file names may have any bytes.
        return f"{str(path)!r} is not valid UTF-8; rename the file or its folder."
    return ""


def open_regular(path: Path | str) -> BinaryIO:
    """Open a regular file for reading.

    Raises OSError for others: opening a pipe may block, and a device may be endless.
    """
    open_flags = os.O_RDONLY | getattr(os, "O_BINARY", 0)
    try:
        descriptor = os.open(path, open_flags | getattr(os, "O_NONBLOCK", 0))
    except BlockingIOError:  # A file server holds a lease, and gives it up to one that waits.
        if not stat.S_ISREG(Path(path).stat().st_mode):
            raise
        descriptor = os.open(path, open_flags)
    try:
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            raise OSError(errno.EINVAL, "it is not a file", str(path))
        return os.fdopen(descriptor, "rb")
    except BaseException:
        os.close(descriptor)
        raise


def read_regular(path: Path | str, max_bytes: int) -> bytes:
    """Return the content of a small regular file.

    Raises OSError for others, as `open_regular` does, and for a larger file.
    """
    with open_regular(path) as file:
        content = file.read(max_bytes + 1)
    if len(content) > max_bytes:
        raise OSError(errno.EFBIG, "it is too large", str(path))
    return content


@contextmanager
def write_atomically(path: Path | str) -> Iterator[Path]:
    """Yield a temporary path next to `path`; on success, move it to `path`.

    On any exception the temporary file is removed and `path` is unchanged. The content is on
    the disk before the move: after a power failure `path` holds the old or the new content.

    Raises
    ------
    FileAccessError
        The folder is missing or may not be written to, or the disk is full.
    """
    path = Path(path)
    part = path.with_name(f"{_part_stem(path)}{token_hex(PART_BYTES)}{path.suffix}")
    try:
        try:  # Not tempfile's: Ctrl-C during its creation leaves the file, or is dropped.
            yield part
            with part.open("rb+") as file:
                os.fsync(file.fileno())
            part.replace(path)
        finally:
            part.unlink(missing_ok=True)
    except OSError as error:
        raise unwritable_error(path, error) from None


def remove_leftovers(paths: Iterable[Path]) -> None:
    """Remove the temporary files of `write_atomically` for these paths.

    Only a killed process or a power failure leaves any. No other process may be writing these
    paths.
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
