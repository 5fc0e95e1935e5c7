"""Recognize the columns of tables with a line for each joint of each frame."""

import re
from collections.abc import Sequence
from typing import NamedTuple

from ..containers import NUMBER, is_missing
from ..point_bodies import (
    TimeCells,
    TimeName,
    column_of_times,
    is_frame_title,
    is_quantity,
    time_name,
)

_NUMBER = r"(?:[_ ]?(?:id|index|idx|number|num|no|nr))"
JOINT = re.compile(
    r"(?P<kind>(?:(?:body|skeleton|tracked)[_ ]?)?"
    r"(?:joint|landmark|key[_ ]?point|point|marker|bone)|body[_ ]?part|part|name"
    r"|gelenk|knochen|articulation|articulaci\u00f3n"
    rf"|segment|tracker|device|sensor)s?(?:[_ ]?(?:name|type|label)|(?P<number>{_NUMBER}))?"
)  # fmt: skip
"""Title of the joints, by name or number; those of devices come last."""
KINDS = ("name", "segment", "tracker", "device", "sensor")
"""Words that may also stand for something else than a joint, from the best to the worst."""
PERSON = re.compile(
    r"(?:person|body|track|tracking|subject|skeleton|actor|player|user|human)"
    rf"(?:{_NUMBER}|[_ ]?name)?"
)
IDENTITIES = frozenset(("id", "pid"))
"""Titles of the person in tables that state a joint of a frame several times without it; others
have a number of the line or of the joint there."""
CONFIDENCE = ("visibility", "vis", "confidence", "score", "v", "likelihood")
UNIT = re.compile(r"\s*[(\[]\w+[)\]]$")
"""Unit in the title of a coordinate."""
AXIS = re.compile(r"(?P<head>.*?)(?P<axis>[xyz])(?P<tail>_(?:m|pos|world|global)|3d)?")
OF_WORLD = re.compile(r"world|global|3d")
OF_PICTURE = re.compile(r"pixel|image|screen|norm|uv|2d|depth|colou?r")
"""Word in the title of a coordinate in a picture."""
HEADS = frozenset(("", "pos", "position", "location", "translate", "t", "world", "global"))
"""What stands before the axis in titles of positions; others come after these."""
NO_PLACE = re.compile(
    r"(?:^|_)(?:dir|direction|normal|tangent|forward|up|offset|delta|size|extent|bbox|box|std)s?$"
)
"""Word in the title of another vector than a position."""
OF_PARENT = re.compile(r"local|relative|parent")
"""Word in the title of a position that is not in the room."""
NO_POSITION = frozenset("qrvaswnd")
"""First letters of other quantities than positions, such as in `qx`."""


class LongColumns(NamedTuple):
    """Columns of a table, by index; None where it has no such column."""

    frame: int | None
    time: int | None
    times: TimeCells
    joint: int
    person: int | None
    identity: int | None
    """Column that may be the person (`IDENTITIES`)."""
    axes: tuple[int, ...]
    """Those of x, y and z; of a picture, of x and y."""
    confidence: int | None
    has_landmarks: bool = False
    """Whether joints are called landmarks, as MediaPipe's are."""
    others: tuple[int, ...] = ()
    """Columns of words, which may distinguish lines of one joint and frame."""


def long_columns(
    titles: Sequence[str], cells: Sequence[Sequence[str]] = ()
) -> LongColumns | None:
    """Return the columns of a table with a line for each joint; None if one is missing.

    Parameters
    ----------
    titles : sequence of str
    cells : sequence of sequences of str
        Cells of the first lines below, if they are known.
    """
    lower = [UNIT.sub("", title).strip().lower().replace(" ", "_") for title in titles]
    time = column_of_times(titles)
    frame = next((at for at, title in enumerate(lower) if is_frame_title(title)), None)
    joint = _joint_column(lower)
    axes = _axes(lower)
    if joint is None or not axes or (frame is None and time is None):
        return None
    person = next((at for at, title in enumerate(lower) if PERSON.fullmatch(title)), None)
    person = None if person == joint else person
    identity = next((at for at, title in enumerate(lower) if title in IDENTITIES), None)
    confidence = next((lower.index(title) for title in CONFIDENCE if title in lower), None)
    times = TimeCells((time_name(titles[time]) if time is not None else None) or TimeName(None))
    used = {frame, time, joint, person, identity, confidence, *axes}
    others = tuple(at for at in _columns_of_words(cells) if at not in used)
    return LongColumns(
        frame, time, times, joint, person, identity, axes, confidence,
        "landmark" in lower[joint], others,
    )  # fmt: skip


def number_of_frame(cell: bytes) -> bytes:
    """Return a number, or the last one in the name of a frame, such as `frame_0012.png`."""
    if NUMBER.fullmatch(cell):
        return cell
    numbers = re.findall(rb"\d+(?:\.0+)?(?=\D*$)", cell)
    return numbers[-1] if numbers else b""


def number_or_missing(cell: bytes) -> bytes:
    """Return a number; a word, such as `High` for a confidence, is a missing one."""
    return cell if NUMBER.fullmatch(cell) else b""


def _joint_column(lower: Sequence[str]) -> int | None:
    """Return the column of joints: named ones before numbered ones, devices last."""
    found = {at: match for at, title in enumerate(lower) if (match := JOINT.fullmatch(title))}

    def order(at: int) -> tuple[int, bool]:
        kind = found[at]["kind"]
        return (KINDS.index(kind) + 1 if kind in KINDS else 0), found[at]["number"] is not None

    return min(found, key=order, default=None)


def _axes(lower: Sequence[str]) -> tuple[int, ...]:
    """Return the columns of x, y and z, those of the world before others.

    What stands around the axis may be anything but another quantity; it is the same in all
    three, or they are next to each other. Without them it is x and y of a picture, or empty.
    """
    matches = {at: match for at, title in enumerate(lower) if (match := AXIS.fullmatch(title))}
    matches = {at: match for at, match in matches.items() if _is_position(match)}
    groups: dict[tuple[str, str], dict[str, int]] = {}
    for at, match in matches.items():
        groups.setdefault((match["head"], match["tail"] or ""), {})[match["axis"]] = at
    rows = [tuple(map(group.get, "xyz")) for group in groups.values() if len(group) == 3]
    rows = rows or [
        (at, at + 1, at + 2)
        for at in matches
        if [matches[near]["axis"] for near in (at, at + 1, at + 2) if near in matches]
        == [*"xyz"]
    ]
    found = [tuple(at for at in row if at is not None) for row in rows]
    flat = (lower.index("x"), lower.index("y")) if {"x", "y"} <= {*lower} else ()
    return min(found, key=lambda row: (*_rank(lower[row[0]]), row), default=flat)


def _rank(title: str) -> tuple[bool, bool, bool]:
    """Return the rank of a title of x: of the parent, not of the world, of no known name."""
    match = AXIS.fullmatch(title)
    head = match["head"].rstrip("_ .") if match else title
    return OF_PARENT.search(title) is not None, not _is_of_world(title), head not in HEADS


def _is_of_world(title: str) -> bool:
    return any(OF_WORLD.fullmatch(word) for word in re.split(r"[_\s.]", title)) or (
        title.endswith("3d")
    )


def _is_position(match: re.Match[str]) -> bool:
    head = match["head"].rstrip("_ .")
    is_other = len(head) == 1 and head in NO_POSITION
    return not (
        is_other or is_quantity(head) or OF_PICTURE.search(head) or NO_PLACE.search(head)
    )


def _columns_of_words(cells: Sequence[Sequence[str]]) -> list[int]:
    """Return the columns whose cells are all words."""
    width = min(map(len, cells), default=0)
    return [
        column
        for column in range(width)
        if not any(
            is_missing(cell.encode()) or NUMBER.fullmatch(cell.encode())
            for cell in (row[column] for row in cells)
        )
    ]
