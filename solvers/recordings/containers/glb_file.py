"""Read nodes and animation of binary glTF files, without meshes and images.

The format is described at https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...errors import InvalidFileError
from ...json_text import parse_json
from .text import map_bytes

MAGIC, JSON_CHUNK, BINARY_CHUNK = b"glTF", 0x4E4F534A, 0x004E4942
HEADER, CHUNK_HEADER = 12, 8
MAX_JSON_BYTES = 1 << 26
COMPONENTS = {5120: "i1", 5121: "u1", 5122: "i2", 5123: "u2", 5125: "u4", 5126: "f4"}
"""Number formats of accessors, by their code."""
SIZES = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}


def json_length(head: bytes) -> int:
    """Return the bytes of the JSON chunk that a file announces; 0 if it is no binary glTF."""
    if head[:4] != MAGIC or len(head) < HEADER + CHUNK_HEADER:
        return 0
    length, kind = np.frombuffer(head, "<u4", 2, HEADER)
    return int(length) if kind == JSON_CHUNK else 0


class GlbFile:
    """A binary glTF file.

    Parameters
    ----------
    path : Path or str

    Raises
    ------
    InvalidFileError
        The file is missing, truncated or not a binary glTF file.
    """

    def __init__(self, path: Path | str) -> None:
        self.path = path
        content = map_bytes(path)
        length = json_length(content[: HEADER + CHUNK_HEADER])
        start = HEADER + CHUNK_HEADER
        if not 0 < length <= min(MAX_JSON_BYTES, len(content) - start):
            raise self.damaged()
        try:
            self.json = parse_json(content[start : start + length])
        except ValueError:
            raise self.damaged() from None
        if not isinstance(self.json, dict):
            raise self.damaged()
        at = start + length
        self._binary = b""
        if at + CHUNK_HEADER <= len(content):
            size, kind = np.frombuffer(content, "<u4", 2, at)
            if kind == BINARY_CHUNK:
                self._binary = content[at + CHUNK_HEADER : at + CHUNK_HEADER + int(size)]

    def damaged(self) -> InvalidFileError:
        """Return the error for contents that contradict each other."""
        return InvalidFileError(f"{self.path} is damaged or cut short. Export it again.")

    def items(self, key: str) -> list[Mapping[str, Any]]:
        """Return the objects of a list such as `nodes`; empty if it is missing."""
        found = self.json.get(key, [])
        if not isinstance(found, list) or not all(isinstance(each, dict) for each in found):
            raise self.damaged()
        return found

    def item(self, key: str, index: Any) -> Mapping[str, Any]:
        """Return an object of a list, by its index."""
        found = self.items(key)
        if not isinstance(index, int) or not 0 <= index < len(found):
            raise self.damaged()
        return found[index]

    def numbers(self, index: Any) -> Array:
        """Return the values of an accessor, shape (count, n); integers become -1 to 1."""
        accessor = self.item("accessors", index)
        view = self.item("bufferViews", accessor.get("bufferView"))
        kind = COMPONENTS.get(accessor.get("componentType", 0))
        size = SIZES.get(str(accessor.get("type")), 0)
        counts = [
            accessor.get("count"), accessor.get("byteOffset", 0), view.get("byteOffset", 0),
            view.get("byteStride", 0), view.get("buffer"),
        ]  # fmt: skip
        if not kind or not size or not all(isinstance(n, int) and n >= 0 for n in counts):
            raise self.damaged()
        count, offset, start, stride, buffer = counts
        if buffer or "sparse" in accessor or "uri" in self.item("buffers", 0):
            raise InvalidFileError(
                f"{self.path} keeps its animation in another file or in parts. Export it as one"
                " file."
            )
        width = size * np.dtype(kind).itemsize
        stride = stride or width
        first = start + offset
        if not count or first + (count - 1) * stride + width > len(self._binary):
            raise self.damaged()
        strides = (stride, width // size)
        rows: NDArray[Any] = np.ndarray((count, size), "<" + kind, self._binary, first, strides)
        with np.errstate(invalid="ignore"):  # Damaged floats may be signaling NaN.
            values: Array = rows.astype(np.float64)
        if kind == "f4":
            return values
        return np.asarray(np.maximum(values / np.iinfo(kind).max, -1.0))


def vector(value: Any, default: Sequence[float]) -> Array:
    """Return the numbers of a translation, (3,), or rotation, (4,), or the default."""
    if not isinstance(value, list) or len(value) != len(default):
        return np.array(default)
    try:
        found = np.array(value, dtype=np.float64)
    except (ValueError, TypeError, OverflowError):
        return np.array(default)
    return found if np.isfinite(found).all() else np.array(default)
