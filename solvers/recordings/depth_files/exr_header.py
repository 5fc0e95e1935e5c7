"""Check the header of an OpenEXR image without decompressing it."""

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
"""Version flag: another header may follow."""
MAX_ATTRIBUTES = 10_000
"""Maximum number of attributes of a file; Blender writes about 20."""
MAX_NAME_BYTES, MAX_BYTES = 255, 100_000
"""Maximum size of an attribute's name, and of a value that is read."""
MAX_VALUES = 4 * MAX_PIXELS**2
"""Maximum number of values in an image: four channels of the largest size."""
CHANNEL_FACTS = 16
"""Bytes after the name of a channel: type, linearity and sampling."""


def check_exr(path: Path) -> None:
    """Raise InvalidFileError unless the header is that of a plausible depth image.

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
            " read at this size. Write depth to its own file."
        )


def _parts(file: BinaryIO) -> Iterator[tuple[int, int, int]]:
    """Yield width, height and number of channels of each part."""
    magic, version = struct.unpack("<4sI", file.read(8))
    if magic != MAGIC:
        raise ValueError("it is another format")
    n_remaining = MAX_ATTRIBUTES
    while attributes := dict(_attributes(file, n_remaining)):
        left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
        yield right - left + 1, bottom - top + 1, _n_channels(attributes["channels"])
        n_remaining -= len(attributes)
        if not version & MULTIPART:
            return


def _attributes(file: BinaryIO, n_remaining: int) -> Iterator[tuple[str, bytes]]:
    """Yield the attributes of the next header; values that are not needed are empty."""
    while name := _read_text(file):
        _read_text(file)  # the type
        (size,) = struct.unpack("<I", file.read(4))
        is_needed = name in ("dataWindow", "channels")
        n_remaining -= 1
        if n_remaining < 0 or (is_needed and size > MAX_BYTES):
            raise ValueError("the header does not end")
        yield name, file.read(size) if is_needed else b""
        if not is_needed:
            file.seek(size, 1)


def _read_text(file: BinaryIO) -> str:
    """Return the text up to the next null byte."""
    text = b""
    while (letter := file.read(1)) != b"\0":
        text += letter
        if not letter or len(text) > MAX_NAME_BYTES:
            raise ValueError("a name does not end")
    return text.decode("latin-1")


def _n_channels(content: bytes) -> int:
    """Return the length of a channel list."""
    n_channels, offset = 0, 0
    while content[offset : offset + 1] not in (b"", b"\0"):
        offset = content.index(b"\0", offset) + 1 + CHANNEL_FACTS
        n_channels += 1
    return n_channels
