"""NumPy's files, read without believing what their headers promise, and without unpickling."""

import warnings
import zipfile
from math import prod
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidFileError
from ..files import DAMAGE

MAGIC = b"\x93NUMPY"
GREATEST_RATIO, ALWAYS_ALLOWED = 200, 1_000_000
"""How much more than its file an archive may hold: recordings do not shrink like that."""


def read_array(path: Path | str) -> NDArray[np.float64]:
    """Return the numbers of a `.npy` file; raises InvalidFileError for whatever else."""
    path = Path(path)
    if not path.is_file():
        raise InvalidFileError(f"There is no file {path}.")
    try:
        with path.open("rb") as file:
            return _read(file, path.stat().st_size)
    except DAMAGE:
        raise _damaged(path) from None


def read_archive(path: Path | str, names: tuple[str, ...]) -> list[NDArray[np.float64]]:
    """Return arrays of numbers of a `.npz` archive; raises InvalidFileError where one fails."""
    path = Path(path)
    if not path.is_file():
        raise InvalidFileError(f"There is no file {path}.")
    try:
        with zipfile.ZipFile(path) as archive:
            arrays = []
            for name in names:
                member = archive.getinfo(f"{name}.npy")
                allowed = GREATEST_RATIO * path.stat().st_size + ALWAYS_ALLOWED
                if member.file_size > allowed:
                    raise ValueError(name)
                with archive.open(member) as file:
                    arrays.append(_read(file, member.file_size))
            return arrays
    except (*DAMAGE, RuntimeError):  # RuntimeError: the member is encrypted.
        raise _damaged(path) from None


def array_header(file: IO[bytes]) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    """Return shape, whether by column, and type, and stop where the numbers begin."""
    formats: Any = np.lib.format  # which has no types
    version = formats.read_magic(file)
    headers = {(1, 0): formats.read_array_header_1_0, (2, 0): formats.read_array_header_2_0}
    with warnings.catch_warnings():  # of headers that only an old Python or NumPy would read
        warnings.simplefilter("ignore")
        shape, by_column, kind = headers[version](file)
    return shape, by_column, kind


def _read(file: IO[bytes], size: int) -> NDArray[np.float64]:
    shape, by_column, kind = array_header(file)
    if kind.kind not in "fiu" or prod(shape) * kind.itemsize > size:
        raise ValueError(kind)
    content: Any = file.read(prod(shape) * kind.itemsize)
    array = np.frombuffer(content, kind).reshape(shape, order="F" if by_column else "C")
    with np.errstate(invalid="ignore", over="ignore"):  # of damaged or very large floats
        return array.astype(np.float64)


def _damaged(path: Path) -> InvalidFileError:
    return InvalidFileError(
        f"{path} is no readable file of NumPy's with arrays of numbers: it is damaged, cut"
        " short or of another kind. Export it again."
    )
