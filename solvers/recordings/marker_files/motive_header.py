"""Read the header of the CSV export of OptiTrack Motive: what each column is."""

from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

from ...errors import InvalidFileError
from ..containers import LineReader, decode_text, find_separator, split_cells

MAX_HEADER_LINES = 40
BONE, RIGID_BODY, MARKER = "bone", "rigid body", "marker"
AXES = ("X", "Y", "Z", "W")


class MotiveItem(NamedTuple):
    """A marker, rigid body or bone, and its columns by axis."""

    kind: str
    name: str
    parent: str
    position: dict[str, int]
    rotation: dict[str, int]


class MotiveHeader(NamedTuple):
    """Header above the frames."""

    fields: dict[str, str]
    """Such as `length units`, in lower case."""
    items: list[MotiveItem]
    has_parents: bool
    separator: bytes
    width: int


def read_motive_header(reader: LineReader, path: Path | str) -> MotiveHeader:
    """Read up to the row that begins with `Frame` and names the axes."""
    lines = reader.peek(MAX_HEADER_LINES)
    separator = find_separator(lines[0]) if lines else b","
    table = [[decode_text(cell) for cell in split_cells(line, separator)] for line in lines]
    last = next((at for at, row in enumerate(table) if row[0].lower() == "frame"), None)
    if last is None:
        raise InvalidFileError(
            f"{path} has no row that begins with Frame and names the axes. It is not a Motive"
            " CSV, or is damaged; export it again."
        )
    axes = table[last]
    reader.take(last + 1)
    above = [row + [""] * (len(axes) - len(row)) for row in table[1:last] if any(row)]
    kinds = next((row for row in above if _is_row_of_types(row)), None)
    if kinds is None or above.index(kinds) + 1 >= len(above):
        raise InvalidFileError(
            f"{path} has no row that states what its columns are, such as Marker or Bone."
            " Export it from Motive with headers."
        )
    names = above[above.index(kinds) + 1]
    parents = next((row for row in above if row[1].lower() == "parent"), None)
    return MotiveHeader(
        fields={key.lower(): value for key, value in pairwise(table[0])},
        items=_items(kinds, names, parents or [""] * len(axes), above[-1], axes),
        has_parents=parents is not None and any(parents[2:]),
        separator=separator,
        width=len(axes),
    )


def _is_row_of_types(row: list[str]) -> bool:
    kinds = {cell.lower() for cell in row[2:]}
    return row[1].lower() == "type" or not kinds.isdisjoint({BONE, MARKER, RIGID_BODY})


def _items(
    kinds: list[str], names: list[str], parents: list[str], channels: list[str], axes: list[str]
) -> list[MotiveItem]:
    """Return what has a position, in the order of the columns."""
    items: dict[tuple[str, str], MotiveItem] = {}
    for column in range(2, len(axes)):
        kind, name, axis = kinds[column].lower(), names[column], axes[column].upper()
        channel = channels[column].lower()
        if not kind or axis not in AXES or channel not in {"position", "rotation"}:
            continue
        item = items.setdefault((kind, name), MotiveItem(kind, name, parents[column], {}, {}))
        columns = item.position if channel == "position" else item.rotation
        columns.setdefault(axis, column)
    return [item for item in items.values() if {"X", "Y", "Z"} <= item.position.keys()]
