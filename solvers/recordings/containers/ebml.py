"""Parse EBML, the syntax of Matroska files: elements with an ID, a size and content.

`ebmlite` is not used: its wheel installs a package called `tests` into the folder that all
add-ons of Blender share, it scans elements of unknown size several times, and it does not
parse blocks and lacing.
"""

import struct
from collections.abc import Iterator
from typing import NamedTuple

MAX_ID_BYTES, MAX_SIZE_BYTES = 4, 8
MAX_HEAD_BYTES = MAX_ID_BYTES + MAX_SIZE_BYTES


class Head(NamedTuple):
    """The header of an element.

    Attributes
    ----------
    number : int
        ID of the element.
    length : int, bytes
        Of the header itself.
    size : int or None, bytes
        Of the content; None if it was unknown when the file was written.
    """

    number: int
    length: int
    size: int | None


def read_head(content: bytes, at: int = 0) -> Head:
    """Read the header of an element; raise ValueError if there is none."""
    end = _length(content, at, MAX_ID_BYTES)
    number = int.from_bytes(content[at : at + end], "big")
    size, taken = read_number(content, at + end)
    unknown = size == (1 << (7 * taken)) - 1
    return Head(number, end + taken, None if unknown else size)


def read_number(content: bytes, at: int) -> tuple[int, int]:
    """Return a variable-length integer and its number of bytes."""
    length = _length(content, at, MAX_SIZE_BYTES)
    encoded = int.from_bytes(content[at : at + length], "big")
    return encoded & ((1 << (7 * length)) - 1), length


def read_signed_number(content: bytes, at: int) -> tuple[int, int]:
    """Return a signed variable-length integer and its number of bytes."""
    number, length = read_number(content, at)
    return number - ((1 << (7 * length - 1)) - 1), length


def _length(content: bytes, at: int, max_length: int) -> int:
    """Return the number of bytes of an integer, from the leading zeros of its first byte."""
    if at >= len(content):
        raise ValueError(at)
    length = 9 - content[at].bit_length()
    if length > max_length or at + length > len(content):
        raise ValueError(at)
    return length


def children(content: bytes) -> Iterator[tuple[int, bytes]]:
    """Yield ID and content of the children of an element; raise ValueError if damaged."""
    at = 0
    while at < len(content):
        head = read_head(content, at)
        at += head.length
        if head.size is None or at + head.size > len(content):
            raise ValueError(at)
        yield head.number, content[at : at + head.size]
        at += head.size


def unsigned(content: bytes) -> int:
    """Return the unsigned integer in an element; raise ValueError above 8 bytes."""
    if len(content) > 8:
        raise ValueError(len(content))
    return int.from_bytes(content, "big")


def text(content: bytes) -> str:
    """Return the text in an element."""
    return content.split(b"\0")[0].decode("utf-8", errors="replace")


def split_lacing(content: bytes, flags: int, size: int) -> list[tuple[int, int]]:
    """Split a block into its frames.

    Parameters
    ----------
    content : bytes
        The start of the block, after its header.
    flags : int
        Bits 1 and 2 are the lacing: none, Xiph, fixed-size or EBML.
    size : int, bytes
        Of the complete block after its header.

    Returns
    -------
    list of (int, int)
        Offset and size of each frame in bytes.

    Raises
    ------
    ValueError, IndexError
        The sizes are invalid.
    """
    kind = flags >> 1 & 3
    if not kind:
        return [(0, size)]
    n_frames = content[0] + 1
    read = {1: _xiph_sizes, 2: _equal_sizes, 3: _ebml_sizes}[kind]
    sizes, at = read(content, n_frames, size)
    frames = []
    for each in sizes:
        frames.append((at, each))
        at += each
    if min(sizes) < 0 or at > size:
        raise ValueError(sizes)
    return frames


def _xiph_sizes(content: bytes, n_frames: int, size: int) -> tuple[list[int], int]:
    sizes, at = [], 1
    for _ in range(n_frames - 1):
        each = 0
        while content[at] == 255:
            each, at = each + 255, at + 1
        sizes.append(each + content[at])
        at += 1
    return [*sizes, size - at - sum(sizes)], at


def _equal_sizes(content: bytes, n_frames: int, size: int) -> tuple[list[int], int]:
    each, rest = divmod(size - 1, n_frames)
    if rest:
        raise ValueError(rest)
    return [each] * n_frames, 1


def _ebml_sizes(content: bytes, n_frames: int, size: int) -> tuple[list[int], int]:
    at, sizes = 1, list[int]()
    for index in range(n_frames - 1):
        number, taken = (
            read_number(content, at) if not index else read_signed_number(content, at)
        )
        sizes.append(number + (sizes[-1] if sizes else 0))
        at += taken
    return [*sizes, size - at - sum(sizes)], at


def block_head(content: bytes) -> tuple[int, int, int, int]:
    """Return track, time within the cluster, flags, and header length of a block."""
    track, length = read_number(content, 0)
    time, flags = struct.unpack_from(">hB", content, length)
    return track, time, flags, length + 3
