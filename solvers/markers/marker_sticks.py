"""Lines between the markers of a known set, so that they look like a body."""

from collections.abc import Sequence
from itertools import pairwise

from .marker_sets import PREFIX, find_marker_set

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


def find_marker_sticks(names: Sequence[str]) -> tuple[tuple[int, int], ...]:
    """Return pairs of points to connect, for each subject whose marker set is known.

    Parameters
    ----------
    names : sequence of str
        Points of a take; names of other sets get no lines.

    Returns
    -------
    tuple of (int, int)
        Indices of names, the lower one first, without repetitions.
    """
    matches = [PREFIX.match(name.strip()) for name in names]
    subjects = dict.fromkeys(match[1] or "" for match in matches if match)
    index_of = {name: index for index, name in reversed(list(enumerate(names)))}
    pairs: dict[tuple[int, int], None] = {}
    for subject in subjects:
        markers = find_marker_set(names, subject).markers
        for chain in CHAINS:
            present = [index_of[markers[landmark]] for landmark in chain if landmark in markers]
            for one, other in pairwise(present):
                if one != other:
                    pairs[min(one, other), max(one, other)] = None
    return tuple(pairs)
