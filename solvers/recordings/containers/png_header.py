"""What a PNG file says of its picture, without unpacking it."""

import os
import struct
from pathlib import Path
from typing import NamedTuple

from ...errors import InvalidFileError
from .listed_images import open_listed

SIGNATURE = b"\x89PNG\r\n\x1a\n"
END = b"IEND\xaeB`\x82"
GREY = 0


class PngHeader(NamedTuple):
    """Size of a picture in pixels, bits of one channel, and whether it is grey."""

    width: int
    height: int
    bits: int
    grey: bool


def read_png_header(root: Path, name: str) -> PngHeader | None:
    """Return what a PNG says of itself; None where it is missing, damaged or cut short.

    Raises InvalidFileError if it lies outside of the folder `root`.
    """
    try:
        with open_listed(root, name) as file:
            head = file.read(26)
            file.seek(-len(END), os.SEEK_END)
            whole = file.read(len(END)) == END
    except OSError:
        return None
    if not whole or len(head) < 26 or head[:8] != SIGNATURE or head[12:16] != b"IHDR":
        return None
    width, height, bits, kind = struct.unpack(">IIBB", head[16:26])
    return PngHeader(width, height, bits, kind == GREY)


def is_png(root: Path, name: str) -> bool:
    """Tell by the first bytes; not if it lies outside of the folder `root`."""
    try:
        with open_listed(root, name) as file:
            return file.read(len(SIGNATURE)) == SIGNATURE
    except (OSError, InvalidFileError):
        return False
