"""What optical marker sets call their markers, and which set a take was captured with."""

import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

SIDED = (
    "SHO", "UPA", "ELB", "FRM", "WRA", "WRB", "FIN",
    "THI", "KNE", "TIB", "ANK", "HEE", "TOE", "MT5",
)  # fmt: skip
TRUNK = ("C7", "T10", "CLAV", "STRN", "RBAK")
HEAD = ("LFHD", "RFHD", "LBHD", "RBHD")
PELVIS = ("LASI", "RASI", "LPSI", "RPSI", "SACR")
LANDMARKS = (*PELVIS, *TRUNK, *HEAD, *(side + landmark for side in "LR" for landmark in SIDED))
"""Places on the body that a marker can sit on, by their Plug-in-Gait names."""

_BOTH = ("THI", "KNE", "TIB", "ANK", "HEE", "TOE")
_ARMS = ("SHO", "UPA", "ELB", "FRM", "WRA", "WRB", "FIN")


def _same_names(landmarks: Sequence[str]) -> dict[str, str]:
    return {landmark: landmark for landmark in landmarks}


def _two_sided(landmarks: Sequence[str]) -> list[str]:
    return [side + landmark for side in "LR" for landmark in landmarks]


SETS: dict[str, Mapping[str, str]] = {
    "Plug-in-Gait": _same_names((*HEAD, *TRUNK, *_two_sided(_ARMS), *PELVIS[:4]))
    | _same_names(_two_sided(_BOTH)),
    "Plug-in-Gait with a sacral marker": _same_names((*HEAD, *TRUNK, *_two_sided(_ARMS)))
    | _same_names(("LASI", "RASI", "SACR", *_two_sided(_BOTH))),
    "CMU 41": _same_names((*HEAD, *TRUNK[:4], *_two_sided(_ARMS)))
    | {"RBAC": "RBAK", "LFWT": "LASI", "RFWT": "RASI", "LBWT": "LPSI", "RBWT": "RPSI"}
    | _same_names(_two_sided(("THI", "KNE", "ANK", "HEE", "TOE", "MT5")))
    | {"LSHN": "LTIB", "RSHN": "RTIB"},
}
"""Landmark of each marker's name, by set."""

ESSENTIAL = (
    "LASI", "RASI",
    *(side + landmark for side in "LR" for landmark in ("KNE", "ANK", "TOE")),
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
    markers : mapping of landmark to the marker's name in the take
        Landmarks carry their Plug-in-Gait names, whatever the set calls them.
    score : float
        0 to 1: the share of the set's markers that the take has.
    subject : str
        What stands before the markers' names (`Anna:`), or empty.
    """

    name: str
    markers: Mapping[str, str]
    score: float
    subject: str = ""

    def missing_landmarks(self) -> tuple[str, ...]:
        """Return the essential landmarks without a marker."""
        missing = [landmark for landmark in ESSENTIAL if landmark not in self.markers]
        if not {"LPSI", "RPSI"} <= set(self.markers) and "SACR" not in self.markers:
            missing.append("LPSI and RPSI, or SACR")
        return tuple(missing)


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
            {landmark: found[label] for label, landmark in table.items() if label in found},
            sum(label in found for label in table) / len(table),
            who,
        )
        for who, found in people.items()
        for title, table in SETS.items()
    ]
    best = max(fits, key=lambda one: (len(one.markers), one.score), default=None)
    return best if best is not None and best.markers else MarkerSet("", {}, 0.0)
