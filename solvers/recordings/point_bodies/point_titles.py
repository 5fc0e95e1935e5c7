"""Read which point and which axis the title of a column states."""

import re
from collections.abc import Collection, Sequence
from typing import NamedTuple

from ...motion import roles_by_name

SIGNS = r"[\s_.:\-|/\[(]"
KINDS = r"pos(?:i(?:tion)?)?|loc(?:ation)?|translat(?:e|ion)|tr?|world"
COORDINATE = re.compile(
    rf"(?P<name>.*?)(?:(?<!cam){SIGNS}+(?:{KINDS}))?{SIGNS}*(?P<axis>[xyz]|(?<=\[)[012])[)\]]?"
    r"(?P<room>3[dD]|[\s_]+(?:world|global|3[dD]))?(?:\s*[(\[](?P<unit>\w+)[)\]]|_(?P<ending>mm?|cm))?",
    re.IGNORECASE,
)
"""`t` is a kind of coordinate, but `cam_t` is where a body is in the space of its camera."""
AXIS_FIRST = re.compile(
    rf"(?:(?:{KINDS}){SIGNS}*)?(?P<axis>[xyz])(?:{SIGNS}(?P<name>.+)|(?P<number>\d+))",
    re.IGNORECASE,
)
AXES_OF_NUMBERS = str.maketrans("012", "xyz")
NUMBERED_AXIS = re.compile(r"(?P<name>.+?)[_.\-](?P<axis>[0-3])")
"""A title such as `nose_0`, where all points have the same three numbers."""
NO_POSITION = re.compile(
    r"(rotations?|rotate|quat(ernion)?|euler|orientation|velocit(y|ies)|accelerations?|torque"
    r"|speed|velo|angles?|winkel|drehung|geschwindigkeit|beschleunigung|vitesse|acc[ée]l[ée]ration"
    r"|[áa]ngulo|rotaci[óo]n|orientaci[óo]n|velocidad|aceleraci[óo]n"
    r"|(^|[\s_.:\-])(rot|orient|scale\w*|(ang|lin)?(vel|acc)|ang|omega|force|moment|gyro?|mag"
    r"|std|error|deg(rees?)?|rad(ians?)?)"
    r"|(?-i:(?<=[a-z\d])(Rot|Quat|Vel|Acc|Ang|Scale|Force)))$",
    re.IGNORECASE,
)
"""Ends of the names of columns that hold no positions, in English, German, French, Spanish."""
NO_LENGTH = re.compile(
    r"deg(rees?)?|grad|rad(ians?)?|px|pix(els?)?|n|newtons?|g|hz|mps|dps|percent", re.IGNORECASE
)
"""Units of other quantities than positions."""
POSITION_LETTER = re.compile(r"(?P<name>.{2,})[_.\-]p", re.IGNORECASE)
"""A name such as `Hips.p`, next to `Hips.q`."""
MAX_TITLE_CHARACTERS = 400
"""Characters of the title of a coordinate. It bounds the run time of the patterns."""
LETTER = re.compile(r"(?P<name>.+)[\s_.:\-](?P<letter>[a-z])", re.IGNORECASE)
LOCAL = re.compile(r"(?:^|[\s_.:\-])[Ll]ocal|(?<=[a-z\d])Local|(?:^|[\s_.:\-])[Rr]elative")
"""Begin of the word for positions relative to the parent bone."""
MIN_IN_ROOM = 8
"""Points without that word, from which those with it are left out. By definition a body."""
QUANTITIES = frozenset("qrvawp")
"""Letters of quantities: quaternion, rotation, velocity, acceleration, turn rate, position.
The right side, or one of points from A to Z, has the same letter."""


class Coordinate(NamedTuple):
    """What the title of a column states."""

    name: str
    axis: str
    unit: str
    """Empty if it is not stated."""
    is_in_room: bool = False
    """Whether the end of the title says so, such as `_world` or `3d`."""


def coordinate_of_title(title: str) -> Coordinate | None:
    """Return the point and axis of a column; None for what is no coordinate."""
    if len(title) > MAX_TITLE_CHARACTERS:
        return None
    for pattern in (COORDINATE, AXIS_FIRST):
        match = pattern.fullmatch(title.strip())
        if match is None:
            continue
        parts = match.groupdict()
        name = (parts.get("name") or parts.get("number") or "").strip(" _.:-|/[(")
        unit = parts.get("unit") or parts.get("ending") or ""
        if name and not is_quantity(name) and not NO_LENGTH.fullmatch(unit):
            axis = match["axis"].lower().translate(AXES_OF_NUMBERS)
            return Coordinate(name, axis, unit, bool(parts.get("room")))
    return None


def is_quantity(name: str) -> bool:
    """Return whether a name ends with a word for another quantity than a position."""
    return NO_POSITION.search(name) is not None


def without_letter(names: Sequence[str]) -> tuple[str, ...]:
    """Return names without the letter of positions, if all have it."""
    matches = [POSITION_LETTER.fullmatch(name) for name in names]
    plain = tuple(match["name"] for match in matches if match)
    return plain if len(plain) == len(names) else tuple(names)


def names_of_positions(names: Collection[str]) -> list[str]:
    """Return the names without those of other quantities of a point, such as `Hips_r`.

    `hand_r` is the right hand if there is a `hand_l`, or if a body with it has a `hand_l`.
    """
    in_room = [name for name in names if not LOCAL.search(name)]
    names = in_room if len(in_room) >= MIN_IN_ROOM else names
    letters: dict[str, set[str]] = {}
    matches = {name: LETTER.fullmatch(name) for name in names}
    for match in filter(None, matches.values()):
        letters.setdefault(match["name"].lower(), set()).add(match["letter"].lower())
    bare = {name.lower() for name in names}
    right = [name for name, found in letters.items() if found == {"r"} and name not in bare]
    is_right_side = bool(roles_by_name([f"{name}_{side}" for name in right for side in "lr"]))

    def is_position(match: re.Match[str] | None) -> bool:
        letter = match["letter"].lower() if match else "p"
        name = match["name"].lower() if match else ""
        is_label = match is not None and not letters[name] <= QUANTITIES
        is_label = is_label or (is_right_side and name in right)
        return letter not in QUANTITIES or letter == "p" or (is_label and letter != "q")

    return [name for name, match in matches.items() if is_position(match)]


def numbered_axes(titles: Sequence[str]) -> dict[str, dict[str, int]]:
    """Return the columns of points whose axes are numbers; else empty."""
    found: dict[str, dict[str, int]] = {}
    for column, title in enumerate(titles):
        match = NUMBERED_AXIS.fullmatch(title.strip())
        if match and not is_quantity(match["name"]):
            found.setdefault(match["name"], {})[match["axis"]] = column
    found = {name: found[name] for name in names_of_positions(found)}
    numbers = {"".join(sorted(axes)) for axes in found.values()}
    if len(numbers) != 1 or not numbers <= {"012", "123"}:
        return {}
    order = numbers.pop()
    return {
        name: {axis: axes[number] for axis, number in zip("xyz", order, strict=True)}
        for name, axes in found.items()
    }
