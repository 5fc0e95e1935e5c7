"""The grammar of Matroska files: elements with a number, a size and what is in them.

`ebmlite` would read it too, but its wheel brings a package called `tests` into the folder that
all add-ons of a Blender share, it walks elements of unknown size several times, and knows
nothing of blocks and lacing; reading numbers and sizes is all that would be left to it.
"""

import struct
from collections.abc import Iterator
from typing import NamedTuple

MAX_ID_BYTES, MAX_SIZE_BYTES = 4, 8
MAX_HEAD_BYTES = MAX_ID_BYTES + MAX_SIZE_BYTES


class Head(NamedTuple):
    """What precedes the content of an element.

    Attributes
    ----------
    number : int
        Tells what the element is.
    length : int, bytes
        Of the head itself.
    size : int or None, bytes
        Of the content; None where it was not known when it was written.
    """

    number: int
    length: int
    size: int | None


def read_head(content: bytes, at: int = 0) -> Head:
    """Read the head of an element; raises ValueError where there is none."""
    end = _length(content, at, MAX_ID_BYTES)
    number = int.from_bytes(content[at : at + end], "big")
    size, taken = read_number(content, at + end)
    unknown = size == (1 << (7 * taken)) - 1
    return Head(number, end + taken, None if unknown else size)


def read_number(content: bytes, at: int) -> tuple[int, int]:
    """Return a number of changing length, and how many bytes it takes."""
    length = _length(content, at, MAX_SIZE_BYTES)
    whole = int.from_bytes(content[at : at + length], "big")
    return whole & ((1 << (7 * length)) - 1), length


def read_signed_number(content: bytes, at: int) -> tuple[int, int]:
    """Return a number of changing length that may be negative, and how many bytes it takes."""
    number, length = read_number(content, at)
    return number - ((1 << (7 * length - 1)) - 1), length


def _length(content: bytes, at: int, longest: int) -> int:
    """How many bytes a number takes: the leading zeros of its first byte tell."""
    if at >= len(content):
        raise ValueError(at)
    length = 9 - content[at].bit_length()
    if length > longest or at + length > len(content):
        raise ValueError(at)
    return length


def children(content: bytes) -> Iterator[tuple[int, bytes]]:
    """Yield number and content of the elements in an element; raises ValueError if damaged."""
    at = 0
    while at < len(content):
        head = read_head(content, at)
        at += head.length
        if head.size is None or at + head.size > len(content):
            raise ValueError(at)
        yield head.number, content[at : at + head.size]
        at += head.size


def unsigned(content: bytes) -> int:
    """Return the whole number in an element; raises ValueError for a longer one."""
    if len(content) > 8:
        raise ValueError(len(content))
    return int.from_bytes(content, "big")


def text(content: bytes) -> str:
    """Return the text in an element."""
    return content.split(b"\0")[0].decode("utf-8", errors="replace")


def split_lacing(content: bytes, flags: int, size: int) -> list[tuple[int, int]]:
    """Divide a block into its frames.

    Parameters
    ----------
    content : bytes
        The beginning of the block, behind its head.
    flags : int
        Bits 1 and 2 tell how frames are laced: not at all, as Xiph does, equal, as EBML does.
    size : int, bytes
        Of the whole block behind its head.

    Returns
    -------
    list of (int, int)
        Where each frame begins, and its size in bytes.

    Raises
    ------
    ValueError, IndexError
        The sizes make no sense.
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
    for place in range(n_frames - 1):
        number, taken = (
            read_number(content, at) if not place else read_signed_number(content, at)
        )
        sizes.append(number + (sizes[-1] if sizes else 0))
        at += taken
    return [*sizes, size - at - sum(sizes)], at


def block_head(content: bytes) -> tuple[int, int, int, int]:
    """Return track, time within the cluster, flags, and how long the head of a block is."""
    track, length = read_number(content, 0)
    time, flags = struct.unpack_from(">hB", content, length)
    return track, time, flags, length + 3
