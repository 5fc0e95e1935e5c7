"""Assign humanoid roles to joints by their names."""

import re
import unicodedata
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from itertools import accumulate
from operator import and_, eq
from typing import NamedTuple

from .tables import CENTRAL_ROLES, COLUMNS, FINGERS, SIDES, TABLES

SIDE_OF_WORD = {"left": "left", "right": "right", "l": "left", "r": "right"}
"""Side that a word of a name stands for."""
OPPOSITE = {"left": "right", "right": "left", "l": "r", "r": "l"}

MIN_PREFIX_FRACTION = 0.75
"""Fraction of joints that share a first or last word that says nothing ("mixamorig", "Bip01",
"JNT"), or that an exporter has numbered ("Hips_01", "Spine_02"). Chosen by hand on the rigs of
`tests/solvers/motion`."""
MIN_PREFIXED_JOINTS = 15
"""Joints that share such a first word where hair, clothes and props have others, and names that
two of these words share if both are of a body, such as "IK" and "DEF". By definition the joints
of a body that VRM requires."""

WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+|[^\W\d_A-Za-z]+")
MIN_SIDED_JOINTS = 6
"""Joints with a mirrored name, from which a single letter in that place is a side."""

EXPORT_NUMBER = re.compile(r"(.+)_#?(\d+)$")
SIDE_WORDS = {
    **dict.fromkeys(("links", "linke", "linker", "linkes", "gauche", "izquierdo", "izquierda",
                     "izq"), "left"),
    **dict.fromkeys(("rechts", "rechte", "rechter", "rechtes", "droit", "droite", "derecho",
                     "derecha"), "right"),
}  # fmt: skip
"""Words for the sides in other languages."""
JAPANESE_SIDES = str.maketrans({"左": " left ", "右": " right "})
FINGER = re.compile(
    r"(thumb|index|mid(?:dle)?|ring|pinky|little|親指|人指|人差指|中指|薬指|小指).*?"
    r"(0?[123]|metacarpal|proximal|intermediate|medial|distal)$"
)
SPELLINGS = {
    "mid": "Middle", "pinky": "Little", "親指": "Thumb", "人指": "Index", "人差指": "Index",
    "中指": "Middle", "薬指": "Ring", "小指": "Little",
}  # fmt: skip
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
    return dict(_cached_roles(tuple(names)))


@lru_cache(maxsize=64)
def _cached_roles(names: tuple[str, ...]) -> tuple[tuple[str, str], ...]:
    """Return roles and names, cached because a live stream has the same names in each frame."""
    return tuple(with_fingers(names, max(name_matches(names), key=len)).items())


def name_matches(names: Sequence[str]) -> list[dict[str, str]]:
    """Return joint names by role, without fingers, one match for each table of `TABLES`."""
    plain = _without_export_numbers(names)
    original = dict(zip(reversed(plain), reversed(names), strict=True))
    keys = _keys(plain)
    matches = [_match_table(row, keys) for row in TABLES.values()]
    return [{role: original[name] for role, name in match.items()} for match in matches]


def naming_scheme(names: Sequence[str]) -> str:
    """Return the title of the table of `TABLES` that matches most roles; empty if none does."""
    matches = dict(zip(TABLES, name_matches(names), strict=True))
    best = max(matches, key=lambda title: len(matches[title]))
    return best if matches[best] else ""


def with_fingers(names: Sequence[str], found: Mapping[str, str]) -> dict[str, str]:
    """Return the joints by role, with those of the fingers."""
    plain = _without_export_numbers(names)
    original = dict(zip(reversed(plain), reversed(names), strict=True))
    hands = {role: plain[list(names).index(name)] for role, name in found.items()}
    fingers = {role: original[name] for role, name in _fingers(plain, hands).items()}
    return {**found, **fingers}


def _without_export_numbers(names: Sequence[str]) -> list[str]:
    """Return names without the numbers that an exporter gave to nearly all of them."""
    numbered = [match for name in names if (match := EXPORT_NUMBER.match(name))]
    numbers = {match[2] for match in numbered}
    n_joints = sum(not name.endswith("_end") for name in names)
    if len(numbers) < max(3, MIN_PREFIX_FRACTION * n_joints):
        return list(names)
    return [EXPORT_NUMBER.sub(r"\1", name) for name in names]


def split_names(names: Sequence[str]) -> list[tuple[str, list[str]]]:
    """Return "left", "right" or "" and the other words of each joint's name."""
    spelling = _find_spelling(names)
    return [_side_and_words(name, spelling) for name in names]


def _match_table(row: Sequence[str], keys: dict[Key, str]) -> dict[str, str]:
    """Return the joints that one table matches, by role."""
    roles: dict[str, str] = {}
    for column, spellings in zip(COLUMNS, row, strict=True):
        for side in ("",) if column in CENTRAL_ROLES else SIDES:
            for spelling in spellings.split():
                joint = keys.get((side, "".join(_words(spelling))))
                if joint is not None and joint not in roles.values():
                    roles[side + column] = joint
                    break
    return roles


def _keys(names: Sequence[str]) -> dict[Key, str]:
    """Return joints by side and name, with and without the rig's prefix."""
    spelling = _find_spelling(names)
    split = [_side_and_words(name, spelling) for name in names]
    keys: dict[Key, str] = {}
    for name, (side, words) in zip(names, split, strict=True):
        keys.setdefault((side, "".join(words)), name)
    for stripped in _without_shared_words(split):
        for name, (side, words) in zip(names, stripped, strict=True):
            keys.setdefault((side, "".join(words)), name)
    return keys


def _without_shared_words(
    split: list[tuple[str, list[str]]],
) -> Iterator[list[tuple[str, list[str]]]]:
    """Yield sides and words without the rig's last and first words, as long as it has some."""
    for end in (-1, 0):
        while shared := _shared_words(split, end):
            split = [(side, _without_word(words, shared, end)) for side, words in split]
            yield split


def _without_word(words: list[str], shared: set[str], end: int) -> list[str]:
    if len(words) < 2 or words[end] not in shared:
        return words
    return words[1:] if end == 0 else words[:-1]


def _shared_words(split: Sequence[tuple[str, list[str]]], end: int) -> set[str]:
    """Return the first or last word that nearly all names share, or that of one body.

    Where two bodies have a first word of their own, neither is preferred.
    """
    counts = Counter(words[end] for _, words in split if len(words) > 1)
    minimum = max(3, MIN_PREFIX_FRACTION * len(split))
    common = {word for word, count in counts.items() if count >= minimum}
    if common or end == -1:
        return common
    bodies = {word for word, count in counts.items() if count >= MIN_PREFIXED_JOINTS}
    joints = Counter((side, *words[1:]) for side, words in split if bodies & {*words[:1]})
    n_twice = sum(count > 1 for count in joints.values())
    return bodies if n_twice < MIN_PREFIXED_JOINTS else set()


class _Spelling(NamedTuple):
    """Spelling of the sides in a skeleton's names."""

    names: frozenset[str]
    """All names, in lower case and without separators."""
    letter_positions: frozenset[int]
    """Positions, in its names, of the words "l" and "r" that stand for a side."""


def _find_spelling(names: Sequence[str]) -> _Spelling:
    split = [_words(re.split(r"[:|]", name)[-1]) for name in names]
    bare = frozenset("".join(words) for words in split)
    letters = Counter(
        index
        for words in split
        for index, word in enumerate(words)
        if word in {"l", "r"} and _mirrored(words, index) in bare
    )
    confirmed = {index for index, count in letters.items() if count >= MIN_SIDED_JOINTS}
    return _Spelling(bare, frozenset(confirmed | _balanced_letters(split)))


def _balanced_letters(split: Sequence[Sequence[str]]) -> set[int]:
    """Return at which word as many names have an "l" as have an "r", as numbered joints do."""
    counts = Counter(
        (index, word)
        for words in split
        for index, word in enumerate(words)
        if word in {"l", "r"}
    )
    return {
        index
        for (index, word), count in counts.items()
        if word == "l" and count == counts[index, "r"] >= MIN_SIDED_JOINTS // 2
    }


def _side_and_words(name: str, spelling: _Spelling) -> tuple[str, list[str]]:
    """Split "mixamorig:LeftUpLeg" into "left" and its other words.

    A single letter, or one attached to the name as in "lfemur", is a side only if the other
    side has the same joint, or most joints have their letter there: "L5" is a vertebra and
    "lowerback" is not a left "owerback".
    """
    words = [*_words(re.split(r"[:|]", name)[-1])]
    for index, word in enumerate(words):
        if word in SIDE_OF_WORD and (
            len(word) > 1
            or _mirrored(words, index) in spelling.names
            or (index in spelling.letter_positions and max(map(len, words)) > 2)
        ):
            return SIDE_OF_WORD[word], words[:index] + words[index + 1 :]
    for index, word in enumerate(words):
        for side in SIDE_OF_WORD:
            remainder = word.removeprefix(side)
            if remainder == word and len(side) > 1:
                remainder = word.removesuffix(side)
            other = [*words[:index], _swap_side(word, side, remainder), *words[index + 1 :]]
            if remainder not in {word, ""} and "".join(other) in spelling.names:
                return SIDE_OF_WORD[side], [*words[:index], remainder, *words[index + 1 :]]
    return "", words


def _mirrored(words: Sequence[str], index: int) -> str:
    return "".join([*words[:index], OPPOSITE[words[index]], *words[index + 1 :]])


def _swap_side(word: str, side: str, remainder: str) -> str:
    return OPPOSITE[side] + remainder if word.startswith(side) else remainder + OPPOSITE[side]


@lru_cache(maxsize=4096)  # those of all tables, and of several rigs
def _words(name: str) -> tuple[str, ...]:
    """Split at separators, digits and capitals: "J_Bip_L_UpperArm" is j, bip, l, upper, arm."""
    plain = unicodedata.normalize("NFKC", name).translate(JAPANESE_SIDES)
    words = (word.lower() for word in WORD.findall(plain))
    return tuple(SIDE_WORDS.get(word, word) for word in words)


def _fingers(names: Sequence[str], roles: Mapping[str, str]) -> dict[str, str]:
    """Return the finger joints by role; a finger of one joint only (CMU) has no role.

    If several joints match one role (DEF- and ORG- bones), the name most similar to the hand's
    is used.
    """
    candidates_by_finger: dict[tuple[str, str], dict[int, list[str]]] = {}
    spelling = _find_spelling(names)
    split = [_side_and_words(name, spelling) for name in names]
    matches = [
        [(side, FINGER.search("".join(words))) for side, words in stripped]
        for stripped in (split, *_without_shared_words(split))
    ]
    fingers = max(reversed(matches), key=_count_finger_joints)
    for name, (side, match) in zip(names, fingers, strict=True):
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


def _count_finger_joints(matches: Sequence[tuple[str, re.Match[str] | None]]) -> int:
    return len({(side, *match.groups()) for side, match in matches if match})


def _best_match(hand: str, names: Sequence[str]) -> str:
    """Return the name with the longest common prefix with the hand's."""
    return max(names, key=lambda name: sum(accumulate(map(eq, hand, name), and_)))


def _part(finger: str, part: int) -> str:
    middle = (
        ("Metacarpal", "Proximal") if finger == FINGERS[0] else ("Proximal", "Intermediate")
    )
    return (*middle, "Distal")[part]
