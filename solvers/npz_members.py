"""Members of archives of arrays (npz): read within bounds, checked, and never unpickled.

A small archive may announce, and unpack to, arrays of any size. Every reader therefore names
the members that it needs and their valid content. Headers are checked before memory is
allocated, and other members are not unpacked.
"""

import io
import os
import warnings
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from math import prod
from typing import IO, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .files import DAMAGE

MAX_BYTES = 1 << 32
MAX_HEADER_BYTES = 1024
"""Maximum bytes of the header of an array; 118 are typical."""
MAX_ASYMMETRY = 1e-4
"""Difference between elements of a covariance across its diagonal, as a fraction of its
largest; products of many frames round differently on either side. By definition of single
precision 1e-7, times the root of a million frames."""
MAX_NUMBER = 2.0**53
"""Largest size of a learned number, a ratio of the largest in a file to 1. By definition of
double precision: next to larger ones, 1 is rounded away, and their products may overflow."""
MAX_LENGTH_ERROR = 1e-6
"""Ratio by which the length of a unit quaternion may differ from 1. By definition of single
precision 1e-7, times the root of a product of a hundred."""
READABLE = (*DAMAGE, RuntimeError)
"""Errors of zipfile and numpy on damaged archives; RuntimeError on encrypted ones."""


class SizeLimit(NamedTuple):
    """Maximum unpacked size: the larger of a constant and a multiple of the file size.

    `MAX_BYTES` is the upper limit of both.
    """

    always: int
    ratio: int


LEARNED = SizeLimit(64_000_000, 20)
"""For learned models, which compress little: the shipped ones by a third."""
RECORDED = SizeLimit(1_000_000, 200)
"""For recordings, which compress more due to small integers and gaps."""


class ArrayHeader(NamedTuple):
    """The header of an array."""

    shape: tuple[int, ...]
    by_column: bool
    dtype: np.dtype[Any]
    start: int
    """Bytes of the header."""

    @property
    def n_bytes(self) -> int:
        """Bytes of the data."""
        return prod(self.shape) * self.dtype.itemsize


@dataclass(frozen=True)
class Values:
    """The valid content of a member.

    Attributes
    ----------
    kinds : str
        Valid kinds of elements, as letters of NumPy.
    shape : tuple of int or str, or None
        A text names a size that is equal in all members; "3*parts" is three times that size.
        None: any shape.
    minimum, maximum : float
        Valid range.
    finite : bool
        Whether NaN, infinity and numbers above `MAX_NUMBER` are invalid.
    optional : bool
        Whether the member may be missing.
    or_empty : bool
        Whether the member may also be empty, with shape (0,).
    least_eigenvalue : float, optional
        For symmetric matrices in the last two axes, which may be covariances: the smallest
        valid eigenvalue, as a fraction of the largest element. None: no matrices.
    unit_length : bool
        Whether the last axis holds unit vectors, such as quaternions.
    """

    kinds: str
    shape: tuple[int | str, ...] | None
    minimum: float = -np.inf
    maximum: float = np.inf
    finite: bool = True
    optional: bool = False
    or_empty: bool = False
    least_eigenvalue: float | None = None
    unit_length: bool = False


def numbers(*shape: int | str, **more: Any) -> Values:
    """Return the description of numbers of any kind."""
    return Values("fiub", shape, **more)


def quaternions(*shape: int | str, **more: Any) -> Values:
    """Return the description of unit quaternions; their axis of 4 comes after the shape."""
    return numbers(*shape, 4, unit_length=True, **more)


def integers(*shape: int | str, **more: Any) -> Values:
    """Return the description of integers."""
    return Values("iu", shape, **more)


def covariances(*shape: int | str, least_eigenvalue: float, **more: Any) -> Values:
    """Return the description of symmetric matrices that can be inverted.

    Either as they are (`least_eigenvalue` above 0) or with a ridge added (below 0, for the
    rounding of what was saved).
    """
    return numbers(*shape, least_eigenvalue=least_eigenvalue, **more)


def flags(*shape: int | str, **more: Any) -> Values:
    """Return the description of booleans; older files may hold 0 and 1."""
    return Values("biu", shape, minimum=0, maximum=1, **more)


def words(*shape: int | str, **more: Any) -> Values:
    """Return the description of text."""
    return Values("U", shape, **more)


class DamagedMemberError(ValueError):
    """A member is missing or has invalid content."""


def read_members(
    archive: zipfile.ZipFile, members: Mapping[str, Values], bound: SizeLimit = LEARNED
) -> dict[str, NDArray[Any]]:
    """Return members of an archive after checking all their headers.

    Raises
    ------
    DamagedMemberError
        A member is missing or has invalid content.
    ValueError, OSError and others of `READABLE`
        The archive is damaged or too large.
    """
    existing = set(archive.namelist())
    missing = [
        name
        for name, values in members.items()
        if f"{name}.npy" not in existing and not values.optional
    ]
    if missing:
        raise DamagedMemberError(f"{', '.join(map(repr, missing))} missing")
    headers = {
        name: member_header(archive, name) for name in members if f"{name}.npy" in existing
    }
    _check_headers(headers, members)
    _check_total(archive, sum(header.n_bytes for header in headers.values()), bound)
    arrays = {name: member_content(archive, name) for name in headers}
    for name, array in arrays.items():
        _check_values(name, array, members[name])
    return arrays


def member_header(archive: zipfile.ZipFile, name: str) -> ArrayHeader:
    """Return the header of a member; ValueError if its size does not match."""
    member = archive.getinfo(f"{name}.npy")
    if member.compress_type not in {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}:
        raise zipfile.BadZipFile(f"compressed by method {member.compress_type}")
    with archive.open(member) as file:
        header = array_header(file)
        if header.n_bytes != member.file_size - header.start:
            raise ValueError(f"{name} does not have its stated size")
    return header


def member_content(archive: zipfile.ZipFile, name: str) -> NDArray[Any]:
    """Return the data of a member, in the shape of its header; check its size before."""
    with archive.open(f"{name}.npy") as file:
        return array_content(file, array_header(file))


def array_header(file: IO[bytes]) -> ArrayHeader:
    """Read the header of an array, up to its data."""
    formats: Any = np.lib.format  # which has no types
    magic = file.read(len(formats.MAGIC_PREFIX) + 2)
    read, width = {
        b"\1\0": (formats.read_array_header_1_0, 2),
        b"\2\0": (formats.read_array_header_2_0, 4),
    }[magic[-2:]]
    size = file.read(width)
    if int.from_bytes(size, "little") > MAX_HEADER_BYTES:
        raise ValueError(size)
    head = io.BytesIO(magic + size + file.read(int.from_bytes(size, "little")))
    formats.read_magic(head)
    with warnings.catch_warnings():  # of headers that only an old Python or NumPy would read
        warnings.simplefilter("ignore")
        shape, by_column, dtype = read(head)
    if dtype.hasobject:
        raise ValueError("it holds Python objects, which are never loaded")
    if min(shape, default=0) < 0:
        raise ValueError(shape)
    return ArrayHeader(shape, by_column, dtype, head.tell())


def array_content(file: IO[bytes], header: ArrayHeader) -> NDArray[Any]:
    """Read the data after a header, in its shape and the byte order of this machine."""
    content = file.read(header.n_bytes)
    order: Any = "F" if header.by_column else "C"
    native = header.dtype.newbyteorder("=")
    array = np.frombuffer(content, header.dtype).reshape(header.shape, order=order)
    return array.astype(native, order="K", copy=True)


def _check_total(archive: zipfile.ZipFile, n_bytes: int, bound: SizeLimit) -> None:
    """Raise ValueError if the members would exceed the size limit."""
    file = archive.fp
    size = 0 if file is None else os.fstat(file.fileno()).st_size
    if n_bytes > min(MAX_BYTES, max(bound.always, bound.ratio * size)):
        raise ValueError(f"{n_bytes} bytes stated in a file of {size}")


def _check_headers(headers: Mapping[str, ArrayHeader], members: Mapping[str, Values]) -> None:
    sizes: dict[str, int] = {}
    for name, header in headers.items():
        values = members[name]
        if header.dtype.kind not in values.kinds:
            raise DamagedMemberError(f"{name} has elements of other kinds")
        if values.shape is None or (values.or_empty and header.shape == (0,)):
            continue
        if len(header.shape) != len(values.shape) or not all(
            _fits(size, expected, sizes)
            for size, expected in zip(header.shape, values.shape, strict=True)
        ):
            raise DamagedMemberError(f"the shapes do not fit, first that of {name}")


def _fits(size: int, expected: int | str, sizes: dict[str, int]) -> bool:
    """Return whether a size matches; record the sizes of new names."""
    if isinstance(expected, int):
        return size == expected
    factor, _, name = expected.rpartition("*")
    number, rest = divmod(size, int(factor or 1))
    return not rest and sizes.setdefault(name, number) == number


def _check_values(name: str, array: NDArray[Any], values: Values) -> None:
    if array.dtype.kind == "U":
        return
    if values.finite and not np.isfinite(array).all():
        raise DamagedMemberError(f"not all numbers are finite, first of {name}")
    if values.finite and float(np.abs(array).max(initial=0)) > MAX_NUMBER:
        raise DamagedMemberError(f"{name} has numbers out of range")
    too_small = values.minimum > -np.inf and (array < values.minimum).any()
    if too_small or (values.maximum < np.inf and (array > values.maximum).any()):
        raise DamagedMemberError(f"{name} has numbers out of range")
    if values.unit_length and array.size and not are_unit_vectors(array):
        raise DamagedMemberError(f"{name} has a rotation that is not a unit quaternion")
    if values.least_eigenvalue is not None and not are_covariances(
        array.astype(np.float64), values.least_eigenvalue
    ):
        raise DamagedMemberError(f"{name} holds a matrix that is not a covariance")


def are_unit_vectors(vectors: NDArray[Any]) -> bool:
    """Return whether the vectors (..., n) have a length of 1."""
    lengths = np.linalg.norm(vectors.astype(np.float64), axis=-1)
    return bool((np.abs(lengths - 1.0) < MAX_LENGTH_ERROR).all())


def are_covariances(matrices: NDArray[np.float64], least_eigenvalue: float) -> bool:
    """Return whether matrices (..., n, n) are symmetric, with eigenvalues of this size."""
    if not matrices.size:
        return True
    largest = np.abs(matrices).max(axis=(-2, -1), keepdims=True)
    transposed = matrices.swapaxes(-1, -2)
    if (np.abs(matrices - transposed) > MAX_ASYMMETRY * largest).any():
        return False
    symmetric = 0.5 * (matrices + transposed)
    shift = least_eigenvalue * np.maximum(largest, np.finfo(np.float64).tiny)
    try:
        np.linalg.cholesky(symmetric - shift * np.eye(matrices.shape[-1]))
    except np.linalg.LinAlgError:
        return False
    return True
