"""What a PNG file says of its picture, without unpacking it."""

import os
import struct
from pathlib import Path
from typing import NamedTuple

SIGNATURE = b"\x89PNG\r\n\x1a\n"
END = b"IEND\xaeB`\x82"
GREY = 0


class PngHeader(NamedTuple):
    """Size of a picture in pixels, bits of one channel, and whether it is grey."""

    width: int
    height: int
    bits: int
    grey: bool


def png_header(path: Path) -> PngHeader | None:
    """Return what a PNG says of itself; None where it is missing, damaged or cut short."""
    try:
        with path.open("rb") as file:
            head = file.read(26)
            file.seek(-len(END), os.SEEK_END)
            whole = file.read() == END
    except OSError:
        return None
    if not whole or len(head) < 26 or head[:8] != SIGNATURE or head[12:16] != b"IHDR":
        return None
    width, height, bits, kind = struct.unpack(">IIBB", head[16:26])
    return PngHeader(width, height, bits, kind == GREY)


def is_png(path: Path) -> bool:
    """Tell by the first bytes."""
    try:
        with path.open("rb") as file:
            return file.read(len(SIGNATURE)) == SIGNATURE
    except OSError:
        return False
