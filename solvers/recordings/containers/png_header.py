"""Read the size and format of a PNG image without decompressing it."""

import os
import struct
from pathlib import Path
from typing import NamedTuple

from ...errors import InvalidFileError
from .listed_images import open_listed

SIGNATURE = b"\x89PNG\r\n\x1a\n"
END = b"IEND\xaeB`\x82"
GRAY = 0


class PngHeader(NamedTuple):
    """Size of an image in pixels, bits per channel, and whether it is gray."""

    width: int
    height: int
    bits: int
    gray: bool


def read_png_header(root: Path, name: str) -> PngHeader | None:
    """Return the header of a PNG file; None if the file is missing, damaged or truncated.

    Raises InvalidFileError if it is outside the folder `root`.
    """
    try:
        with open_listed(root, name) as file:
            head = file.read(26)
            file.seek(-len(END), os.SEEK_END)
            is_complete = file.read(len(END)) == END
    except OSError:
        return None
    if not is_complete or len(head) < 26 or head[:8] != SIGNATURE or head[12:16] != b"IHDR":
        return None
    width, height, bits, kind = struct.unpack(">IIBB", head[16:26])
    return PngHeader(width, height, bits, kind == GRAY)


def is_png(root: Path, name: str) -> bool:
    """Return whether a file is PNG, from its first bytes; False outside the folder `root`."""
    try:
        with open_listed(root, name) as file:
            return file.read(len(SIGNATURE)) == SIGNATURE
    except (OSError, InvalidFileError):
        return False
