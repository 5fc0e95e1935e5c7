"""Find limbs in the tree of a skeleton: branches of one joint that mirror each other."""

from collections.abc import Sequence
from functools import cache
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..skeletons import Skeleton
from .names import split_names
from .tables import (
    ARM_ROLES,
    CENTRAL_ROLES,
    COLUMNS,
    FINGER_ROLES,
    LEG_ROLES,
    TABLES,
)

MIN_LIMB_FRACTION = 0.12
"""Shortest limb, relative to the longest path along the bones; an arm takes 0.25. Chosen by
hand on the rigs of `tests/solvers/motion`."""
MAX_DIFFERENCE = 0.25
"""Between both sides' bones, relative to the longer: a captured actor's differ by some percent.
Chosen by hand on the rigs of `tests/solvers/motion`."""
MAX_DIFFERENCE_FRACTION = 0.02
"""The same for short bones, relative to the longest path along the bones. Chosen by hand on the
rigs of `tests/solvers/motion`."""

MAX_BRANCHES = 8
"""Children of a joint that are compared, the longest first; a hand has five fingers."""
MAX_LIMB_JOINTS = 24
MAX_PAIRS_OF_BRANCH = 6
MAX_PAIRS = 16
"""Pairs that are returned, the longest; hair and skirts would make hundreds."""
MAX_COMPARED_BONES = 20_000
"""Comparisons of two bones, after which a rig is too large to be searched further."""


MIN_NAMED_JOINTS = 2
"""Joints with words of the other limb, from which a limb is not the one in question. One joint
may be called after what it carries or controls."""


class MirroredLimbs(NamedTuple):
    """Two branches of one joint that mirror each other."""

    branch: int
    """The joint from which both start."""
    limbs: tuple[list[int], list[int]]
    """Joints of each limb, from the first below the branch to the tip."""

    def joints(self, skeleton: Skeleton) -> NDArray[np.bool_]:
        """Return which joints lie on or below the limbs, shape (n_joints,)."""
        inside = np.zeros(skeleton.n_joints, dtype=bool)
        for limb in self.limbs:
            inside[skeleton.subtree(limb[0])] = True
        return inside


def find_mirrored_limbs(skeleton: Skeleton) -> list[MirroredLimbs]:
    """Return the pairs of equally long branches, from the root on.

    Only lengths are compared, so that neither the rest pose nor its axes matter. Where one
    branch goes on, such as to a prop in one hand, the pair ends before.
    """
    tree, budget = _Tree.of(skeleton), [MAX_COMPARED_BONES]
    shortest = max(MIN_LIMB_FRACTION * tree.longest_path, 1e-9)
    pairs = []
    for branch, children in enumerate(tree.branches):
        long = [child for child in children if tree.reach[child] > shortest]
        limbs = [
            tree.follow(one, other, MAX_LIMB_JOINTS, budget)
            for one, other in combinations(long, 2)
        ]
        long_limbs = [pair for pair in limbs if tree.lengths[pair[0]].sum() > shortest]
        long_limbs.sort(key=lambda pair: -tree.lengths[pair[0]].sum())
        pairs += [MirroredLimbs(branch, pair) for pair in long_limbs[:MAX_PAIRS_OF_BRANCH]]
    pairs.sort(key=lambda pair: -tree.lengths[pair.limbs[0]].sum())
    return sorted(pairs[:MAX_PAIRS], key=lambda pair: pair.branch)


class _Tree(NamedTuple):
    """Lengths along the bones of a skeleton, in meters."""

    lengths: NDArray[np.float64]
    """Of the bone to each joint, shape (n_joints,)."""
    reach: NDArray[np.float64]
    """Of the longest path through this bone to a tip, shape (n_joints,)."""
    branches: list[list[int]]
    """Children of each joint, those with the longest paths first."""
    longest_path: float
    """Between two joints."""

    @classmethod
    def of(cls, skeleton: Skeleton) -> "_Tree":
        lengths = np.linalg.norm(skeleton.offsets, axis=1)
        lengths[0] = 0.0
        reach, longest = lengths.copy(), 0.0
        for joint in range(skeleton.n_joints - 1, 0, -1):
            parent = skeleton.parents[joint]
            below = reach[parent] - lengths[parent]
            longest = max(longest, below + reach[joint])
            reach[parent] = lengths[parent] + max(below, reach[joint])
        branches = [
            sorted(children, key=lambda child: -reach[child])[:MAX_BRANCHES]
            for children in skeleton.children
        ]
        return cls(lengths, reach, branches, longest)

    def follow(
        self, one: int, other: int, n_joints: int, budget: list[int]
    ) -> tuple[list[int], list[int]]:
        """Return the longest paths from two joints down whose bones are equally long.

        Each comparison takes one from the budget; without any left, paths end.
        """
        budget[0] -= 1
        pair = self.lengths[[one, other]]
        tolerance = MAX_DIFFERENCE_FRACTION * self.longest_path
        if (
            budget[0] < 0
            or not n_joints
            or np.ptp(pair) > max(MAX_DIFFERENCE * pair.max(), tolerance)
        ):
            return [], []
        below = (
            self.follow(first, second, n_joints - 1, budget)
            for first in self.branches[one]
            for second in self.branches[other]
        )
        limbs = max(below, key=lambda limbs: self.lengths[limbs[0]].sum(), default=([], []))
        return [one, *limbs[0]], [other, *limbs[1]]


def are_separate(skeleton: Skeleton, legs: MirroredLimbs, arms: MirroredLimbs) -> bool:
    """Whether two pairs of limbs share no joint and start from different joints."""
    shared = legs.joints(skeleton) & arms.joints(skeleton)
    return legs.branch != arms.branch and not shared.any()


def named_as_other_limb(
    words: Sequence[Sequence[str]], limbs: MirroredLimbs, limb: str
) -> bool:
    """Whether the names of both limbs have words of arms where they should be legs, or reverse.

    Parameters
    ----------
    words : of the name of each joint
    limbs : MirroredLimbs
    limb : "Leg" or "Arm"
    """
    own, other = _limb_words(limb), _limb_words("Arm" if limb == "Leg" else "Leg")
    joints = [set(words[joint]) for side in limbs.limbs for joint in side]
    n_own, n_other = (
        sum(not each.isdisjoint(vocabulary) for each in joints) for vocabulary in (own, other)
    )
    return n_other > n_own and n_other >= 2 * MIN_NAMED_JOINTS


@cache
def _limb_words(limb: str) -> frozenset[str]:
    """Return the words that only the names of an arm or only those of a leg have."""
    words: dict[str, set[str]] = {"Leg": set(), "Arm": set(), "": set()}
    of_column = dict.fromkeys(LEG_ROLES, "Leg") | dict.fromkeys(ARM_ROLES, "Arm")
    of_column |= dict.fromkeys(CENTRAL_ROLES, "")
    columns = [
        (of_column[column], spellings.split())
        for row in TABLES.values()
        for column, spellings in zip(COLUMNS, row, strict=True)
    ]
    for key, names in (*columns, ("Arm", FINGER_ROLES)):
        words[key] |= {word for _, split in split_names(names) for word in split}
    others = set().union(*(group for key, group in words.items() if key != limb))
    return frozenset(filter(_has_meaning, words[limb] - others))


def _has_meaning(word: str) -> bool:
    """Whether a word is more than a number, a single letter, or the remainder of one."""
    return word.isalpha() and (len(word) > 2 or word[0] >= "\u3000")
