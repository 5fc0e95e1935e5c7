"""What optical marker sets call their markers, and which set a take was captured with."""

import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

TRUNK = ("C7", "T10", "CLAV", "STRN", "RBAK")
HEAD = ("LFHD", "RFHD", "LBHD", "RBHD")
PELVIS = ("LASI", "RASI", "LPSI", "RPSI", "SACR")

_BOTH = ("THI", "KNE", "TIB", "ANK", "HEE", "TOE")
_ARMS = ("SHO", "UPA", "ELB", "FRM", "WRA", "WRB", "FIN")


def _own_names(spots: Sequence[str]) -> dict[str, str]:
    return {spot: spot for spot in spots}


def _two_sided(spots: Sequence[str]) -> list[str]:
    return [side + spot for side in "LR" for spot in spots]


SETS: dict[str, Mapping[str, str]] = {
    "Plug-in-Gait": _own_names((*HEAD, *TRUNK, *_two_sided(_ARMS), *PELVIS[:4]))
    | _own_names(_two_sided(_BOTH)),
    "Plug-in-Gait with a sacral marker": _own_names((*HEAD, *TRUNK, *_two_sided(_ARMS)))
    | _own_names(("LASI", "RASI", "SACR", *_two_sided(_BOTH))),
    "CMU 41": _own_names((*HEAD, *TRUNK[:4], *_two_sided(_ARMS)))
    | {"RBAC": "RBAK", "LFWT": "LASI", "RFWT": "RASI", "LBWT": "LPSI", "RBWT": "RPSI"}
    | _own_names(_two_sided(("THI", "KNE", "ANK", "HEE", "TOE", "MT5")))
    | {"LSHN": "LTIB", "RSHN": "RTIB"},
}
"""Spot of each marker's name, by set."""

ESSENTIAL = (
    "LASI", "RASI",
    *(side + spot for side in "LR" for spot in ("KNE", "ANK", "TOE")),
)  # fmt: skip
"""What no body can be solved without, besides one marker at the back of the pelvis."""
PREFIX = re.compile(r"^(.*[:.|_ ])?([^:.|_ ]+)$")


@dataclass(frozen=True)
class MarkerSet:
    """Which marker sits where on the body.

    Attributes
    ----------
    name : str
        Of the set that fits best; empty where none does.
    markers : mapping of spot to the marker's name in the take
        Spots carry their Plug-in-Gait names, whatever the set calls them.
    score : float
        0 to 1: the share of the set's markers that the take has.
    subject : str
        What stands before the markers' names (`Anna:`), or empty.
    """

    name: str
    markers: Mapping[str, str]
    score: float
    subject: str = ""

    def lacks(self) -> tuple[str, ...]:
        """Return the essential spots without a marker."""
        lost = [spot for spot in ESSENTIAL if spot not in self.markers]
        if not {"LPSI", "RPSI"} <= set(self.markers) and "SACR" not in self.markers:
            lost.append("LPSI and RPSI, or SACR")
        return tuple(lost)


def find_marker_set(names: Sequence[str], subject: str | None = None) -> MarkerSet:
    """Find out which set a take was captured with, and which marker is which.

    Capital and small letters are the same, and so is whatever stands before the last colon,
    dot, bar, underscore or blank; of two people in one take, the one with more markers wins.

    Parameters
    ----------
    names : sequence of str
        The points of a take. Points of other names are left out.
    subject : str, optional
        Only markers with this before their names, with or without the colon.

    Returns
    -------
    MarkerSet
        The set of which most markers are there, then the one with the greater share of them.
    """
    people: dict[str, dict[str, str]] = defaultdict(dict)
    for name in names:
        match = PREFIX.match(name.strip())
        if match:
            people[match[1] or ""].setdefault(match[2].upper(), name)
    if subject is not None:
        wanted = subject.rstrip(":").lower()
        people = {
            who: found for who, found in people.items() if who.rstrip(":").lower() == wanted
        }
    fits = [
        MarkerSet(
            title,
            {spot: found[label] for label, spot in table.items() if label in found},
            sum(label in found for label in table) / len(table),
            who,
        )
        for who, found in people.items()
        for title, table in SETS.items()
    ]
    best = max(fits, key=lambda one: (len(one.markers), one.score), default=None)
    return best if best is not None and best.markers else MarkerSet("", {}, 0.0)
