"""Assign humanoid roles to joints by their names."""

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import accumulate
from operator import and_, eq

from .tables import CENTRAL_ROLES, COLUMNS, FINGERS, TABLES

SIDES = {"left": "left", "right": "right", "l": "left", "r": "right"}
OPPOSITE = {"left": "right", "right": "left", "l": "r", "r": "l"}

MIN_PREFIX_FRACTION = 0.75
"""Fraction of joints that share a first word which is a prefix ("mixamorig", "Bip01")."""

WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
FINGER = re.compile(
    r"(thumb|index|mid(?:dle)?|ring|pinky|little).*?"
    r"(0?[123]|metacarpal|proximal|intermediate|medial|distal)$"
)
SPELLINGS = {"mid": "Middle", "pinky": "Little"}
PARTS = {
    "1": 0, "2": 1, "3": 2, "metacarpal": 0, "proximal": 0, "intermediate": 1, "medial": 1,
    "distal": 2,
}  # fmt: skip

Key = tuple[str, str]
"""Side ("left", "right" or "") and the name without it, in lower case."""


def roles_by_name(names: Sequence[str]) -> dict[str, str]:
    """Return joint names by humanoid role, from the table that matches most roles.

    Parameters
    ----------
    names : sequence of str
        The joints of one skeleton. Of equivalent names the first one is used.

    Returns
    -------
    dict of role to joint name; empty if no table has any of the names.
    """
    keys = _keys(names)
    roles = max((_match_table(row, keys) for row in TABLES.values()), key=len)
    return roles | _fingers(names, roles)


def _match_table(row: Sequence[str], keys: dict[Key, str]) -> dict[str, str]:
    """Return the joints that one table matches, by role."""
    roles: dict[str, str] = {}
    for column, spellings in zip(COLUMNS, row, strict=True):
        for side in ("",) if column in CENTRAL_ROLES else ("left", "right"):
            for spelling in spellings.split():
                joint = keys.get((side, "".join(_words(spelling))))
                if joint is not None and joint not in roles.values():
                    roles[side + column] = joint
                    break
    return roles


def _keys(names: Sequence[str]) -> dict[Key, str]:
    """Return joints by side and name, with and without the rig's prefix."""
    bare = _bare_names(names)
    split = [_side_and_words(name, bare) for name in names]
    keys: dict[Key, str] = {}
    for name, (side, words) in zip(names, split, strict=True):
        keys.setdefault((side, "".join(words)), name)
    while prefix := _shared_first_word([words for _, words in split]):
        split = [(side, words[words[:1] == [prefix] :]) for side, words in split]
        for name, (side, words) in zip(names, split, strict=True):
            keys.setdefault((side, "".join(words)), name)
    return keys


def _shared_first_word(split: Sequence[Sequence[str]]) -> str:
    counts = Counter(words[0] for words in split if len(words) > 1)
    word, count = counts.most_common(1)[0] if counts else ("", 0)
    return word if count >= max(3, MIN_PREFIX_FRACTION * len(split)) else ""


def _side_and_words(name: str, all_names: frozenset[str]) -> tuple[str, list[str]]:
    """Split "mixamorig:LeftUpLeg" into "left" and its other words.

    A single letter, or one attached to the name as in "lfemur", is a side only if the other
    side has the same joint: "L5" is a vertebra and "lowerback" is not a left "owerback".
    """
    words = _words(re.split(r"[:|]", name)[-1])
    for index, word in enumerate(words):
        if word in SIDES and (len(word) > 1 or _mirrored(words, index) in all_names):
            return SIDES[word], words[:index] + words[index + 1 :]
    for index in {0, len(words) - 1} if words else ():
        word = words[index]
        for side in SIDES:
            remainder = word.removeprefix(side) if index == 0 else word
            remainder = (
                word.removesuffix(side) if remainder == word and len(side) > 1 else remainder
            )
            other = [*words[:index], _swapped(word, side, remainder), *words[index + 1 :]]
            if remainder not in {word, ""} and "".join(other) in all_names:
                return SIDES[side], [*words[:index], remainder, *words[index + 1 :]]
    return "", words


def _mirrored(words: list[str], index: int) -> str:
    return "".join([*words[:index], OPPOSITE[words[index]], *words[index + 1 :]])


def _swapped(word: str, side: str, remainder: str) -> str:
    return OPPOSITE[side] + remainder if word.startswith(side) else remainder + OPPOSITE[side]


def _words(name: str) -> list[str]:
    """Split at separators, digits and capitals: "J_Bip_L_UpperArm" is j, bip, l, upper, arm."""
    return [word.lower() for word in WORD.findall(name)]


def _bare_names(names: Sequence[str]) -> frozenset[str]:
    return frozenset("".join(_words(re.split(r"[:|]", name)[-1])) for name in names)


def _fingers(names: Sequence[str], roles: Mapping[str, str]) -> dict[str, str]:
    """Return the finger joints by role; a finger of one joint only (CMU) has no role.

    If several joints match one role (DEF- and ORG- bones), the name most similar to the hand's
    is used.
    """
    candidates_by_finger: dict[tuple[str, str], dict[int, list[str]]] = {}
    bare = _bare_names(names)
    for name in names:
        side, words = _side_and_words(name, bare)
        match = FINGER.search("".join(words))
        if side and match and not name.endswith("_end"):
            finger = SPELLINGS.get(match[1], match[1].capitalize())
            part = PARTS[match[2].lstrip("0")] + (finger == "Thumb" and match[2] == "proximal")
            candidates_by_finger.setdefault((side, finger), {}).setdefault(part, []).append(
                name
            )
    return {
        side + finger + _part(finger, part): _best_match(
            roles.get(f"{side}Hand", ""), candidates
        )
        for (side, finger), joints in candidates_by_finger.items()
        if len(joints) > 1
        for part, candidates in sorted(joints.items())
    }


def _best_match(hand: str, names: Sequence[str]) -> str:
    """Return the name with the longest common prefix with the hand's."""
    return max(names, key=lambda name: sum(accumulate(map(eq, hand, name), and_)))


def _part(finger: str, part: int) -> str:
    middle = (
        ("Metacarpal", "Proximal") if finger == FINGERS[0] else ("Proximal", "Intermediate")
    )
    return (*middle, "Distal")[part]
