"""Names of the markers of optical marker sets; find the set of a take."""

import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

TRUNK = ("C7", "T10", "CLAV", "STRN", "RBAK")
HEAD = ("LFHD", "RFHD", "LBHD", "RBHD")
PELVIS = ("LASI", "RASI", "LPSI", "RPSI", "SACR")

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
"""Landmarks that every body needs, besides a marker at the back of the pelvis."""
PREFIX = re.compile(r"^(.*[:.|_ ])?([^:.|_ ]+)$")


@dataclass(frozen=True)
class MarkerSet:
    """Assignment of the markers of a take to anatomical landmarks.

    Attributes
    ----------
    name : str
        Name of the set that fits best; empty if none fits.
    markers : mapping of landmark to the marker's name in the take
        Landmarks have their Plug-in-Gait names in every set.
    score : float
        Fraction of the set's markers that the take has, 0 to 1.
    subject : str
        Prefix of the markers' names (`Anna:`), or empty.
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
    """Identify the marker set of a take, and assign its markers to landmarks.

    Letter case is ignored, and so is a prefix up to the last colon, dot, bar, underscore or
    blank. If a take has several subjects, the one with the most markers is used.

    Parameters
    ----------
    names : sequence of str
        Points of a take. Other names are ignored.
    subject : str, optional
        Prefix of the markers to use, with or without the colon.

    Returns
    -------
    MarkerSet
        The set with the most markers in the take; if two tie, the more complete one.
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
