"""Read numeric arrays from NumPy files, with the checks of `npz_members`."""

import os
import zipfile
from collections.abc import Collection
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...files import open_regular
from ...npz_members import READABLE, RECORDED, Values, array_content, array_header, read_members

NPY_MAGIC = b"\x93NUMPY"
MAX_NUMBER = float(np.finfo(np.float32).max)
"""Without unit. By definition: what sensors and networks store has 32 bits."""
NUMBERS = Values("fiu", None, finite=False)


def read_array(path: Path | str) -> NDArray[np.float64]:
    """Return the numbers of a `.npy` file; raise InvalidFileError for other content."""
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


def read_archive_members(
    path: Path | str, names: Collection[str]
) -> dict[str, NDArray[np.float64]]:
    """Return those of these arrays of numbers that a `.npz` archive has.

    Raises InvalidFileError on failure; other members are not read.
    """
    wanted = dict.fromkeys(names, replace(NUMBERS, optional=True))
    try:
        with open_regular(path) as file, zipfile.ZipFile(file) as archive:
            arrays = read_members(archive, wanted, RECORDED)
    except FileNotFoundError:
        raise InvalidFileError(f"There is no file {path}.") from None
    except READABLE:
        raise _damaged(path) from None
    return {name: _as_float(array, path) for name, array in arrays.items()}


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
