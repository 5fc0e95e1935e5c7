"""Group points whose names end with a person, or with an end of a bone."""

import re
from collections.abc import Sequence
from typing import NamedTuple

SUFFIX = re.compile(
    r"(?P<stem>.+?)[\s_:.\-]+(?P<suffix>[a-z]*\d+|head|tail|start|end)", re.IGNORECASE
)
STARTS, ENDS = frozenset(("head", "start")), frozenset(("tail", "end"))
"""Suffixes of both ends of a bone, as in Blender; a joint is where a bone starts."""
MIN_POINTS = 8
"""Number of points with one suffix. By definition a body."""
MIN_SHARED_FRACTION = 0.7
"""Fraction of the points with one suffix that those with another have, too. Chosen by hand as
for people whose names begin those of markers (`split_subjects`)."""


class SuffixGroup(NamedTuple):
    """Points whose names have one suffix."""

    suffix: str
    columns: list[int]
    names: tuple[str, ...]
    """Of the points, without the suffix."""


def groups_by_suffix(names: Sequence[str]) -> list[SuffixGroup]:
    """Return the points of each suffix; of bones, only where they start; else empty.

    All names have one of several suffixes, and nearly the same names before it.
    """
    matches = [SUFFIX.fullmatch(name) for name in names]
    found: dict[str, dict[str, int]] = {}
    for column, match in enumerate(matches):
        if match is None:
            return []
        found.setdefault(match["suffix"].lower(), {})[match["stem"]] = column
    groups = [*found.values()]
    shared = [
        len(group.keys() & groups[0].keys()) >= MIN_SHARED_FRACTION * len(group)
        for group in groups
    ]
    if len(groups) < 2 or not all(shared) or min(map(len, groups)) < MIN_POINTS:
        return []
    if found.keys() <= STARTS | ENDS:
        found = {suffix: group for suffix, group in found.items() if suffix in STARTS}
    return [
        SuffixGroup(suffix, [*group.values()], tuple(group)) for suffix, group in found.items()
    ]
