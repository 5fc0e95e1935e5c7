"""Read which point and which axis the title of a column states."""

import re
from collections.abc import Collection, Sequence
from typing import NamedTuple

SIGNS = r"[\s_.:\-|/\[(]"
KINDS = r"pos(?:ition)?|loc(?:ation)?|translat(?:e|ion)|tr?|world"
COORDINATE = re.compile(
    rf"(?P<name>.*?)(?:{SIGNS}+(?:{KINDS}))?{SIGNS}*(?P<axis>[xyz]|(?<=\[)[012])[)\]]?"
    r"(?:_+(?:world|global))?(?:\s*[(\[](?P<unit>\w+)[)\]]|_(?P<ending>mm?|cm))?",
    re.IGNORECASE,
)
AXIS_FIRST = re.compile(
    rf"(?:(?:{KINDS}){SIGNS}*)?(?P<axis>[xyz])(?:{SIGNS}(?P<name>.+)|(?P<number>\d+))",
    re.IGNORECASE,
)
AXES_OF_NUMBERS = str.maketrans("012", "xyz")
NUMBERED_AXIS = re.compile(r"(?P<name>.+?)[_.\-](?P<axis>[0-3])")
"""A title such as `nose_0`, where all points have the same three numbers."""
NO_POSITION = re.compile(
    r"(rotation|rotate|quat(ernion)?|euler|orientation|velocity|acceleration"
    r"|(^|[\s_.:\-])(rot|orient|angles?|scale|vel|acc|gyro|mag|std|error))$",
    re.IGNORECASE,
)
"""Ends of the names of columns that hold no positions."""
ROTATION = re.compile(r"(?P<name>.+)[\s_.:\-][qr]", re.IGNORECASE)
"""Name of the rotation of a point; without that point, it is one of the right side."""


class Coordinate(NamedTuple):
    """What the title of a column states."""

    name: str
    axis: str
    unit: str
    """Empty if it is not stated."""


def coordinate_of_title(title: str) -> Coordinate | None:
    """Return the point and axis of a column; None for what is no coordinate."""
    for pattern in (COORDINATE, AXIS_FIRST):
        match = pattern.fullmatch(title.strip())
        if match is None:
            continue
        parts = match.groupdict()
        name = (parts.get("name") or parts.get("number") or "").strip(" _.:-|/[(")
        if name and not NO_POSITION.search(name):
            axis = match["axis"].lower().translate(AXES_OF_NUMBERS)
            return Coordinate(name, axis, parts.get("unit") or parts.get("ending") or "")
    return None


def is_rotation(name: str, names: Collection[str]) -> bool:
    """Return whether a name is that of the rotation of another point, such as `Hips_r`."""
    match = ROTATION.fullmatch(name)
    return match is not None and match["name"] in names


def numbered_axes(titles: Sequence[str]) -> dict[str, dict[str, int]]:
    """Return the columns of points whose axes are numbers; else empty."""
    found: dict[str, dict[str, int]] = {}
    for column, title in enumerate(titles):
        if match := NUMBERED_AXIS.fullmatch(title.strip()):
            found.setdefault(match["name"], {})[match["axis"]] = column
    numbers = {"".join(sorted(axes)) for axes in found.values()}
    if len(numbers) != 1 or not numbers <= {"012", "123"}:
        return {}
    order = numbers.pop()
    return {
        name: {axis: axes[number] for axis, number in zip("xyz", order, strict=True)}
        for name, axes in found.items()
    }
