"""Lines between the markers of a known set, so that they look like a body."""

import re
from collections.abc import Container, Iterator, Mapping, Sequence
from itertools import pairwise

from .marker_sets import PREFIX, find_marker_set
from .stick_sets import MIN_LABELS, STICK_SETS, chains_of, plain

HEAD_AND_TRUNK = (
    ("LFHD", "RFHD", "RBHD", "LBHD", "LFHD"),
    ("LBHD", "C7", "RBHD"),
    ("LSHO", "C7", "RSHO", "CLAV", "LSHO"),
    ("CLAV", "STRN"),
    ("C7", "T10"),
    ("RBAK", "T10"),
    ("LASI", "RASI", "RPSI", "LPSI", "LASI"),
    ("LASI", "SACR", "RASI"),
    ("LPSI", "T10", "RPSI"),
    ("SACR", "T10"),
)
LIMBS = (
    ("SHO", "UPA", "ELB", "FRM", "WRA", "FIN", "WRB", "FRM"),
    ("WRA", "WRB"),
    ("ASI", "THI", "KNE", "TIB", "ANK", "TOE", "HEE", "ANK"),
    ("TOE", "MT5", "HEE"),
)
"""Chains of landmarks of one side. A chain goes on over landmarks that have no marker."""
CHAINS = HEAD_AND_TRUNK + tuple(
    tuple(side + landmark for landmark in chain) for side in "LR" for chain in LIMBS
)

SEPARATOR = re.compile(r"[:.|_ ]")
"""Between the subject and the label, as in `PREFIX`."""
Sticks = tuple[tuple[int, int], ...]
"""Pairs of indices."""


def find_marker_sticks(names: Sequence[str]) -> tuple[tuple[int, int], ...]:
    """Return pairs of points to connect, for each subject whose marker set is known.

    Parameters
    ----------
    names : sequence of str
        Points of a take; names of other sets get no lines. Of several sets the one with most
        lines is used.

    Returns
    -------
    tuple of (int, int)
        Indices of names, the lower one first, without repetitions.
    """
    found = [_sticks_of_solved_sets(names), *(_sticks_of(title, names) for title in STICK_SETS)]
    return max(found, key=len)


def _sticks_of_solved_sets(names: Sequence[str]) -> Sticks:
    matches = [PREFIX.match(name.strip()) for name in names]
    subjects = dict.fromkeys(match[1] or "" for match in matches if match)
    index_of = {name: index for index, name in reversed(list(enumerate(names)))}
    sticks: dict[tuple[int, int], None] = {}
    for subject in subjects:
        markers = find_marker_set(names, subject).markers
        indices = {landmark: index_of[name] for landmark, name in markers.items()}
        sticks |= dict.fromkeys(_consecutive_points(indices, CHAINS))
    return tuple(sticks)


def _sticks_of(title: str, names: Sequence[str]) -> Sticks:
    chains = chains_of(title)
    labels = {label for chain in chains for label in chain}
    subjects: dict[str, dict[str, int]] = {}
    for index, name in enumerate(names):
        if found := _split_label(name.strip(), labels):
            subject, label = found
            subjects.setdefault(subject, {}).setdefault(label, index)
    known = [each for each in subjects.values() if len(each) >= MIN_LABELS]
    return tuple(
        dict.fromkeys(pair for each in known for pair in _consecutive_points(each, chains))
    )


def _split_label(name: str, labels: Container[str]) -> tuple[str, str] | None:
    """Return the subject and the label in a name, with the shortest prefix that leaves one."""
    starts = [0, *(match.end() for match in SEPARATOR.finditer(name))]
    parts = ((name[:start], plain(name[start:])) for start in starts)
    return next((part for part in parts if part[1] in labels), None)


def _consecutive_points(
    indices: Mapping[str, int], chains: Sequence[Sequence[str]]
) -> Iterator[tuple[int, int]]:
    """Yield the pairs of points that follow each other on a chain."""
    for chain in chains:
        present = [indices[landmark] for landmark in chain if landmark in indices]
        for one, other in pairwise(present):
            if one != other:
                yield min(one, other), max(one, other)
