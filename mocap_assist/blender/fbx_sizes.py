"""Refuse binary FBX files whose compressed arrays would fill the memory."""

import struct

from ...solvers.errors import InvalidFileError
from ...solvers.files import open_regular
from .stated_conventions import BINARY_FBX

VERSION_OFFSET, FIRST_NODE = 23, 27
"""Bytes, by definition of the format, as the next."""
LONG_HEADERS_VERSION = 7500
ITEM_BYTES = {b"f": 4, b"d": 8, b"l": 8, b"i": 4, b"b": 1, b"c": 1}
PLAIN_BYTES = {b"Y": 2, b"C": 1, b"B": 1, b"I": 4, b"F": 4, b"D": 8, b"L": 8}
MAX_UNFOLDING = 32
"""Bytes of arrays for each byte of a file, a ratio. With the next it bounds the memory: curves
that do not move are stored in few bytes, so that a long take is unfolded 16 times. Twice that
is read, however long the take is."""
UNFOLDED_BYTES = 1 << 30
"""Bytes of arrays that a file of any size may have: 20 minutes of 100 bones at 120 Hz whose
curves for location and scale do not move have as many in them."""


def refuse_inflated_fbx(path: str) -> None:
    """Raise InvalidFileError if arrays of a binary FBX file state far more than it holds."""
    with open_regular(path) as file:
        content = file.read()
    if not content.startswith(BINARY_FBX):
        return
    try:
        total = _unfolded_bytes(content)
    except (struct.error, KeyError):
        return  # damaged, which the importer reports
    if total > UNFOLDED_BYTES + MAX_UNFOLDING * len(content):
        raise InvalidFileError(
            f"{path} states {total / 1e9:.3g} GB of numbers, which it does not hold. Export it"
            " again."
        )


def _unfolded_bytes(content: bytes) -> int:
    """Return the bytes of all arrays, as the headers of these state them."""
    (version,) = struct.unpack_from("<I", content, VERSION_OFFSET)
    header = struct.Struct("<QQQB" if version >= LONG_HEADERS_VERSION else "<IIIB")
    position, ends, total = FIRST_NODE, [len(content)], 0
    while position < len(content):
        end, n_properties, _, n_letters = header.unpack_from(content, position)
        if not end:
            position = ends.pop()
            if not ends:
                break
            continue
        position += header.size + n_letters
        for _ in range(n_properties):
            position, size = _next_property(content, position)
            total += size
        if end > position:
            ends.append(end)
        else:
            position = max(position, end)
    return total


def _next_property(content: bytes, position: int) -> tuple[int, int]:
    """Return where the property ends, and the bytes of its array."""
    code = content[position : position + 1]
    position += 1
    if code in {b"S", b"R"}:
        (length,) = struct.unpack_from("<I", content, position)
        return position + 4 + length, 0
    if code not in ITEM_BYTES:
        return position + PLAIN_BYTES[code], 0
    count, is_packed, n_packed = struct.unpack_from("<III", content, position)
    size = count * ITEM_BYTES[code]
    return position + 12 + (n_packed if is_packed else size), size
