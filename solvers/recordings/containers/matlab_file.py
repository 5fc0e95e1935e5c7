"""List the numeric arrays of a MATLAB 5 file without reading their values.

SciPy's reader is not used: it reads complete arrays, and it accepts the sizes in a damaged
file.
"""

import struct
import zlib
from collections.abc import Iterator
from math import prod
from pathlib import Path
from typing import NamedTuple

from ...errors import InvalidFileError
from ...files import DAMAGE, open_regular
from .stored_bytes import (
    MAX_DEFLATE_RATIO,
    ByteSlice,
    PackedBytes,
    PlainBytes,
    StoredBytes,
    truncation_error,
)

HEADER_BYTES = 128
MATRIX, PACKED = 14, 15
KINDS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8"}
"""NumPy type of each stored type."""
WITH_HEADER = 15
"""`wbits` of zlib for compressed bytes with a zlib header."""
MAX_DIMENSIONS, MAX_NAME_BYTES = 8, 64
MAX_INLINE_BYTES = 4


class MatlabArray(NamedTuple):
    """An array: name, shape, type, and values in column-major order."""

    name: str
    shape: tuple[int, ...]
    kind: str
    content: StoredBytes


def is_matlab(head: bytes) -> bool:
    """Return whether a file is MATLAB 5, from its first bytes; version 7.3 is HDF5."""
    return head[:10] == b"MATLAB 5.0" and head[126:128] in {b"IM", b"MI"}


def matlab_arrays(path: Path) -> list[MatlabArray]:
    """Return the numeric arrays of a file, in their order.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged or truncated.
    """
    try:
        with open_regular(path) as file:
            order = "<" if file.read(HEADER_BYTES)[126:128] == b"IM" else ">"
        arrays = [_array(content, order) for content in _elements(path, order)]
    except FileNotFoundError:
        raise InvalidFileError(f"There is no file {path}.") from None
    except InvalidFileError:
        raise
    except DAMAGE:
        raise InvalidFileError(
            f"{path} is a damaged MATLAB file. Copy or export it again."
        ) from None
    return [array for array in arrays if array is not None]


def _elements(path: Path, order: str) -> Iterator[StoredBytes]:
    """Yield the content of each matrix of the file."""
    at, end = HEADER_BYTES, path.stat().st_size
    while at + 8 <= end:
        kind, size = struct.unpack(f"{order}II", PlainBytes(path, at, 8).read(0, 8))
        at += 8
        if at + size > end:
            raise truncation_error(path)
        if kind == PACKED:
            yield _unpacked(path, at, size, order)
        elif kind == MATRIX:
            yield PlainBytes(path, at, size)
        at += size


def _unpacked(path: Path, at: int, n_compressed: int, order: str) -> StoredBytes:
    with open_regular(path) as file:
        file.seek(at)
        head = zlib.decompressobj().decompress(file.read(min(n_compressed, 1024)), 8)
    kind, size = struct.unpack(f"{order}II", head)
    if kind != MATRIX or size > MAX_DEFLATE_RATIO * n_compressed:
        raise ValueError(kind)
    content = PackedBytes(path, at, n_compressed, size + 8, WITH_HEADER)
    content.check()
    return ByteSlice(content, 8, size)


def _array(content: StoredBytes, order: str) -> MatlabArray | None:
    """Read the header of a matrix; None if it is not numeric."""
    _, flags, at = _element(content, 0, order, 8)
    (number,) = struct.unpack(f"{order}I", flags[:4])
    if not 6 <= number & 0xFF <= 13:  # double to uint32
        return None
    _, lengths, at = _element(content, at, order, 4 * MAX_DIMENSIONS)
    shape = struct.unpack(f"{order}{len(lengths) // 4}i", lengths)
    _, name, at = _element(content, at, order, MAX_NAME_BYTES)
    kind, size, start = _tag(content, at, order)
    stored = f"{order}{KINDS[kind]}"
    if min(shape) < 0 or prod(shape) * int(stored[-1]) != size or start + size > content.size:
        raise ValueError(shape)
    return MatlabArray(name.decode("latin1"), shape, stored, ByteSlice(content, start, size))


def _element(
    content: StoredBytes, at: int, order: str, max_size: int
) -> tuple[int, bytes, int]:
    """Return type and bytes of a short element, and the offset of the next one."""
    kind, size, start = _tag(content, at, order)
    if size > max_size:
        raise ValueError(size)
    end = start + size
    return kind, content.read(start, size), end + -end % 8


def _tag(content: StoredBytes, at: int, order: str) -> tuple[int, int, int]:
    """Return type, size and offset of an element; up to 4 bytes are stored in the tag."""
    first, second = struct.unpack(f"{order}II", content.read(at, 8))
    if first >> 16:
        return first & 0xFFFF, min(first >> 16, MAX_INLINE_BYTES), at + 4
    return first, second, at + 8
