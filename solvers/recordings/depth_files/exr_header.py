"""What an OpenEXR file says of its picture, without unpacking it."""

import struct
from collections.abc import Iterator
from math import prod
from pathlib import Path
from typing import BinaryIO

from ...errors import InvalidFileError
from ...files import open_regular
from .stack import MAX_PIXELS, check_size

MAGIC = b"v/1\x01"
MULTIPART = 0x1000
"""Flag of the version: another header may follow."""
MAX_ATTRIBUTES = 10_000
"""Of a file; Blender writes about 20."""
MAX_NAME_BYTES, MAX_BYTES = 255, 100_000
"""Of an attribute's name, and of one that is read."""
MAX_VALUES = 4 * MAX_PIXELS**2
"""Numbers in a picture: those of red, green, blue and alpha of the largest one."""
CHANNEL_FACTS = 16
"""Bytes that follow the name of a channel: type, linearity and sampling."""


def check_exr(path: Path) -> None:
    """Raise InvalidFileError unless the header is that of a picture a depth camera can make.

    Reference: https://openexr.com/en/latest/OpenEXRFileLayout.html
    """
    try:
        with open_regular(path) as file:
            parts = list(_parts(file))
    except (OSError, ValueError, KeyError, struct.error):
        raise InvalidFileError(f"{path} cannot be read as OpenEXR. Render it again.") from None
    for width, height, _ in parts:
        check_size(path, height, width)
    if sum(map(prod, parts)) > MAX_VALUES:
        raise InvalidFileError(
            f"{path} has {sum(n_channels for *_, n_channels in parts)} channels, too many to"
            " read at this size. Write depth as a file of its own."
        )


def _parts(file: BinaryIO) -> Iterator[tuple[int, int, int]]:
    """Yield width, height and number of channels of each part."""
    magic, version = struct.unpack("<4sI", file.read(8))
    if magic != MAGIC:
        raise ValueError("it is another format")
    room = MAX_ATTRIBUTES
    while attributes := dict(_attributes(file, room)):
        left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
        yield right - left + 1, bottom - top + 1, _n_channels(attributes["channels"])
        room -= len(attributes)
        if not version & MULTIPART:
            return


def _attributes(file: BinaryIO, room: int) -> Iterator[tuple[str, bytes]]:
    """Yield the attributes of the next header, which are empty where they tell no size."""
    while name := _word(file):
        _word(file)  # the type
        (size,) = struct.unpack("<I", file.read(4))
        told = name in ("dataWindow", "channels")
        room -= 1
        if room < 0 or (told and size > MAX_BYTES):
            raise ValueError("the header does not end")
        yield name, file.read(size) if told else b""
        if not told:
            file.seek(size, 1)


def _word(file: BinaryIO) -> str:
    """Return the text up to the next zero byte."""
    word = b""
    while (letter := file.read(1)) != b"\0":
        word += letter
        if not letter or len(word) > MAX_NAME_BYTES:
            raise ValueError("a name does not end")
    return word.decode("latin-1")


def _n_channels(content: bytes) -> int:
    """Return the number of channels that a list of them has."""
    n_channels, place = 0, 0
    while content[place : place + 1] not in (b"", b"\0"):
        place = content.index(b"\0", place) + 1 + CHANNEL_FACTS
        n_channels += 1
    return n_channels
