"""Write files whole or not at all, and keep learned things in archives that cannot run code."""

import struct
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from secrets import token_hex
from tokenize import TokenError
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import InvalidFileError

# What numpy and zipfile were seen to raise on files that are cut short or altered.
DAMAGE = (
    OSError, ValueError, EOFError, KeyError, AttributeError, TypeError, NotImplementedError,
    OverflowError, RecursionError, SyntaxError, TokenError, zipfile.BadZipFile, zlib.error,
    struct.error,
)  # fmt: skip


@contextmanager
def written_whole(path: Path | str) -> Iterator[Path]:
    """Yield a temporary path beside `path`; move it onto `path` if all goes well.

    On any exception the temporary file is removed and `path` is as it was.

    Raises
    ------
    InvalidFileError
        The folder is missing or may not be written to, or the disk is full.
    """
    path = Path(path)
    part = path.with_name(f".{path.stem[:40]}.{token_hex(6)}{path.suffix}")
    try:
        try:  # Not tempfile's: a Ctrl-C that falls into it leaves its file behind, or is lost.
            yield part
            part.replace(path)
        finally:
            part.unlink(missing_ok=True)
    except OSError as error:
        raise InvalidFileError(f"{path} cannot be written: {error.strerror}.") from None


def write_archive(
    path: Path | str, kind: str, version: int, arrays: Mapping[str, NDArray[Any]]
) -> None:
    """Save named arrays as one compressed npz that `read_archive` knows to be a `kind`."""
    with written_whole(path) as part, part.open("wb") as file:
        np.savez_compressed(file, kind=np.array(kind), version=np.array(version), **arrays)


def read_archive(path: Path | str, kind: str, version: int) -> dict[str, NDArray[Any]]:
    """Load what `write_archive` saved. Nothing in the file is ever executed.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, holds something else, or comes from another version.
    """
    try:
        # Opened here, because numpy leaves a file open where it finds no archive in it.
        with Path(path).open("rb") as file, np.load(file, allow_pickle=False) as archive:
            arrays = {name: np.array(archive[name]) for name in archive.files}
    except FileNotFoundError:
        raise InvalidFileError(f"There is no file {path}.") from None
    except DAMAGE as error:
        raise InvalidFileError(f"{path} is not a readable archive ({error}).") from None
    found = str(arrays.pop("kind", "something else"))
    if found != kind:
        raise InvalidFileError(f"{path} holds {found}, not {kind}.")
    saved = arrays.pop("version", np.array(-1))
    if saved.shape != () or int(saved) != version:
        raise InvalidFileError(
            f"{path} was saved as version {saved} of {kind}; this Mocap Assist reads version"
            f" {version}. Learn it again from the clips."
        )
    return arrays
