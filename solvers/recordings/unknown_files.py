"""Say what a file of an unknown format seems to hold, and what would serve instead."""

import re
from collections.abc import Sequence
from pathlib import Path

from ..files import open_regular
from .containers import (
    NUMBER,
    ZIP_MEMBER,
    archive_names,
    as_utf8,
    decode_text,
    find_separator,
    is_missing,
    shown,
    split_cells,
)
from .point_bodies import coordinate_of_title

MAX_BYTES = 1 << 17
"""Bytes of the begin and of the end of a file that are looked at. It bounds the run time."""
MIN_CELLS = 6
"""Number of cells of a line of a table. It guards prose with commas."""
MIN_ROTATIONS = 12
"""Number of titles of rotations, from which a table is one of them: those of four bones. It
decides what the sentence says only."""
ROTATION = re.compile(r"(?i)rot(?!o)|quat|euler|orient|angle|pitch|yaw|roll")
FACE = re.compile(
    r"(?i)(eye|jaw|mouth|brow|cheek|nose)[_ ]?\w*(left|right|open|up|smile|blink)"
)
SENSOR = re.compile(
    rb"(?i)(?<![a-z])(?:acc(?:el(?:eration|erometer)?)?|gyro?(?:scope)?|angular[ _]?velocity"
    rb"|mag(?:net(?:ic(?:[ _]?field)?|ometer))?)[ _./]*[xyz]\b"
)
MIN_SENSOR = 3
"""Number of titles of a sensor's readings, from which a table is one of them: those of one
sensor. It decides what the sentence says only."""
MIN_FACE = 4
"""Number of titles of a face, from which a table is one of a face. It decides what the sentence
says only."""
MIN_NUMERIC_FRACTION = 0.5
"""Numbers among the cells of the first line, a ratio, from which it has no titles. It guards
tables whose first titles are numbers, as of frames."""


def describe_unknown(path: Path | str) -> str | None:
    """Return what a file holds and what would serve; None if that is not recognized.

    Raises OSError if the file cannot be read.
    """
    with open_regular(path) as file:
        head = as_utf8(file.read(MAX_BYTES))
        if head.startswith(ZIP_MEMBER):
            file.seek(max(0, file.seek(0, 2) - MAX_BYTES))
            return _describe_archive(path, head[:300] + file.read())
    if (
        len({title.lower() for title in SENSOR.findall(head)}) >= MIN_SENSOR
        and b"\0" not in head
    ):
        return (
            f"{path} holds readings of sensors, such as of acceleration, without positions."
            " Export BVH, FBX, C3D or MVNX from the program that recorded them."
        )
    lines = [line for line in head.splitlines() if line.strip()]
    if len(lines) < 2 or b"\0" in head or head.lstrip()[:1] in {b"{", b"[", b"<"}:
        return None
    separator = find_separator(lines[0])
    rows = [[decode_text(cell) for cell in split_cells(line, separator)] for line in lines[:2]]
    if len(rows[0]) < MIN_CELLS or abs(len(rows[0]) - len(rows[1])) > 1:
        return None
    return _describe_table(path, rows[0])


def _describe_archive(path: Path | str, content: bytes) -> str | None:
    names = sorted({*archive_names(content)} - {""})
    if not names or ".npy" not in content.decode("latin-1"):
        return None
    return (
        f"{path} is a NumPy archive without joints of a known name ({shown(', '.join(names))})."
        " Save them with numpy.savez(file, joints=...), shape (frames, joints, 3)."
    )


def _describe_table(path: Path | str, titles: Sequence[str]) -> str | None:
    cells = [title.encode() for title in titles]
    numeric = [bool(NUMBER.fullmatch(cell)) or is_missing(cell) for cell in cells]
    if sum(numeric) >= MIN_NUMERIC_FRACTION * len(titles):
        return (
            f"{path} is a table without titles. Write the names of joints and axes, such as"
            " LeftHand_x, in its first line."
        )
    if sum(FACE.fullmatch(title) is not None for title in titles) >= MIN_FACE:
        return f"{path} holds values of a face. Export the body of the take as BVH, FBX or GLB."
    if sum(ROTATION.search(title) is not None for title in titles) >= MIN_ROTATIONS:
        return (
            f"{path} holds rotations of bones without their positions in the room. Export BVH,"
            " FBX or GLB, or the positions of joints."
        )
    found = {found.name for title in titles if (found := coordinate_of_title(title))}
    if found:
        return (
            f"{path} has too few points for a body ({len(found)}). Export the skeleton that"
            " your program makes of them, such as BVH."
        )
    return None
