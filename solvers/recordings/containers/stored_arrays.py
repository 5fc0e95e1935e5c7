"""Read numeric arrays from NumPy files, with the checks of `npz_members`."""

import os
import re
import zipfile
from collections.abc import Callable, Collection
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...files import open_regular
from ...npz_members import READABLE, RECORDED, Values, array_content, array_header, read_members

NPY_MAGIC = b"\x93NUMPY"
ZIP_MEMBER, ZIP_ENTRY = b"PK\x03\x04", b"PK\x01\x02"
"""First bytes of a ZIP archive, and of each entry in its directory."""
MAX_NUMBER = float(np.finfo(np.float32).max)
"""Without unit. By definition: what sensors and networks store has 32 bits."""
NUMBERS = Values("fiu", None, finite=False)
WORDS = Values("U", None)


def read_array(path: Path | str) -> NDArray[np.float64]:
    """Return the numbers of a `.npy` file in its shape; raise InvalidFileError for others."""
    try:
        with open_regular(path) as file:
            header = array_header(file)
            n_available = os.fstat(file.fileno()).st_size - header.start
            if header.dtype.kind not in NUMBERS.kinds or header.n_bytes > n_available:
                raise ValueError(header)
            return _as_float(array_content(file, header), path)
    except FileNotFoundError:
        raise InvalidFileError(f"There is no file {path}.") from None
    except READABLE:
        raise _damaged(path) from None


def read_archive(path: Path | str, names: tuple[str, ...]) -> list[NDArray[np.float64]]:
    """Return arrays of numbers of a `.npz` archive; raise InvalidFileError on failure."""
    try:
        with open_regular(path) as file, zipfile.ZipFile(file) as archive:
            arrays = read_members(archive, dict.fromkeys(names, NUMBERS), RECORDED)
    except FileNotFoundError:
        raise InvalidFileError(f"There is no file {path}.") from None
    except READABLE:
        raise _damaged(path) from None
    return [_as_float(arrays[name], path) for name in names]


def archive_names(content: bytes) -> tuple[str, ...]:
    """Return the names of the arrays of a `.npz` archive; none if it is no ZIP archive.

    `content` is its beginning and its end, where the directory is: `detect_format` has both.
    The name of the first array comes first, and names may repeat.
    """
    if content[: len(ZIP_MEMBER)] != ZIP_MEMBER:
        return ()
    entries = (found.start() for found in re.finditer(ZIP_ENTRY, content))
    names = [
        _name_in_header(content, 0, 26, 30),
        *(_name_in_header(content, at, 28, 46) for at in entries),
    ]
    return tuple(name.decode("ascii", "replace").removesuffix(".npy") for name in names)


def _name_in_header(content: bytes, start: int, length_at: int, name_at: int) -> bytes:
    """Return the name in a header of a ZIP archive, by the offsets of its length and itself."""
    length = int.from_bytes(content[start + length_at : start + length_at + 2], "little")
    return content[start + name_at : start + name_at + length]


def read_archive_members(
    path: Path | str, names: Collection[str], plain: Callable[[str], str] = str
) -> dict[str, NDArray[np.float64]]:
    """Return those of these arrays of numbers that a `.npz` archive has.

    `plain` returns the name that is meant by one as the archive spells it. Raises
    InvalidFileError on failure; other members are not read.
    """
    found = _read_members(path, names, plain, NUMBERS)
    return {name: _as_float(array, path) for name, array in found.items()}


def read_archive_words(path: Path | str, names: Collection[str]) -> tuple[str, ...]:
    """Return the texts in the first of these members that a `.npz` archive has, if any.

    Members with other content are none. Raises InvalidFileError for a damaged archive.
    """
    found = _read_members(path, names, str.lower, WORDS)
    return next((tuple(map(str, array.ravel())) for array in found.values()), ())


def _read_members(
    path: Path | str, names: Collection[str], plain: Callable[[str], str], values: Values
) -> dict[str, NDArray[Any]]:
    try:
        with open_regular(path) as file, zipfile.ZipFile(file) as archive:
            own = [name.removesuffix(".npy") for name in archive.namelist()]
            meant = {name: plain(name) for name in own if plain(name) in names}
            wanted = dict.fromkeys(meant, replace(values, optional=True))
            arrays = read_members(archive, wanted, RECORDED)
    except FileNotFoundError:
        raise InvalidFileError(f"There is no file {path}.") from None
    except READABLE:
        raise _damaged(path) from None
    return {meant[name]: array for name, array in arrays.items()}


def _as_float(array: NDArray[Any], path: Path | str) -> NDArray[np.float64]:
    """Return the numbers; raise InvalidFileError if squares of them have no number."""
    with np.errstate(invalid="ignore", over="ignore"):  # damaged or very large floats
        found = array.astype(np.float64)
        if (np.isfinite(found) & (np.abs(found) > MAX_NUMBER)).any():
            raise _damaged(path)
    return found


def _damaged(path: Path | str) -> InvalidFileError:
    return InvalidFileError(
        f"{path} is not a readable NumPy file of numbers: it is damaged, cut short or of"
        " another kind. Export it again."
    )
