"""Group points whose names end with a person, or with an end of a bone."""

import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ...arrays import Array

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


MAX_DISTANCE_FRACTION = 0.1
"""Median distance of points with one name before the suffix, relative to the size of their
body, up to which they are several markers of one segment. Chosen by hand: those of a cluster
are within 10 cm, and people who dance together have at most some points as close."""


class SuffixGroup(NamedTuple):
    """Points whose names have one suffix."""

    suffix: str
    columns: list[int]
    names: tuple[str, ...]
    """Of the points, without the suffix."""


def groups_by_suffix(names: Sequence[str], points: Array) -> list[SuffixGroup]:
    """Return the points of each suffix; of bones, only where they start; else empty.

    All names have one of several suffixes, and nearly the same names before it. Points with one
    name before it have a distance: otherwise they are markers of one body.

    Parameters
    ----------
    names : length n_points
    points : shape (n_frames, n_points, 3)
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
    elif _are_of_one_body(groups, points):
        return []
    return [
        SuffixGroup(suffix, [*group.values()], tuple(group)) for suffix, group in found.items()
    ]


def _are_of_one_body(groups: Sequence[Mapping[str, int]], points: Array) -> bool:
    """Return whether the points of a group are next to those of each other one."""
    first = groups[0]
    body = points[:, [*first.values()]]
    size = _median(np.fmax.reduce(body, axis=1) - np.fmin.reduce(body, axis=1))
    for group in groups[1:]:
        shared = [*first.keys() & group.keys()]
        pairs = [points[:, [each[stem] for stem in shared]] for each in (first, group)]
        distance = _median(np.linalg.norm(pairs[0] - pairs[1], axis=-1)[..., None])
        if not distance <= MAX_DISTANCE_FRACTION * size:
            return False
    return True


def _median(values: Array) -> float:
    """Return the largest of the medians of columns in known rows; NaN without any."""
    rows = values.reshape(-1, values.shape[-1])
    known = rows[np.isfinite(rows).all(axis=1)]
    return float(np.median(known, axis=0).max()) if len(known) else np.nan
