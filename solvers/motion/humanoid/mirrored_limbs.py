"""Find limbs in the tree of a skeleton: branches of one joint that mirror each other."""

from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..skeletons import Skeleton

MIN_LIMB_FRACTION = 0.12
"""Shortest limb, relative to the longest path along the bones; an arm takes 0.25."""
MAX_DIFFERENCE = 0.25
"""Between both sides' bones, relative to the longer: a captured actor's differ by some
percent."""
MAX_DIFFERENCE_FRACTION = 0.02
"""The same for short bones, relative to the longest path along the bones."""


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
    lengths = np.linalg.norm(skeleton.offsets, axis=1)
    lengths[0] = 0.0
    longest = _longest_path(skeleton, lengths)
    pairs = []
    for branch, children in enumerate(skeleton.children):
        for one, other in combinations(children, 2):
            limbs = _follow(skeleton, one, other, lengths, MAX_DIFFERENCE_FRACTION * longest)
            if lengths[limbs[0]].sum() > max(MIN_LIMB_FRACTION * longest, 1e-9):
                pairs.append(MirroredLimbs(branch, limbs))
    return pairs


def _follow(
    skeleton: Skeleton, one: int, other: int, lengths: NDArray[np.float64], tolerance: float
) -> tuple[list[int], list[int]]:
    """Return the longest paths from two joints down whose bones are equally long."""
    pair = lengths[[one, other]]
    if np.ptp(pair) > max(MAX_DIFFERENCE * pair.max(), tolerance):
        return [], []
    below = (
        _follow(skeleton, first, second, lengths, tolerance)
        for first in skeleton.children[one]
        for second in skeleton.children[other]
    )
    limbs = max(below, key=lambda limbs: lengths[limbs[0]].sum(), default=([], []))
    return [one, *limbs[0]], [other, *limbs[1]]


def _longest_path(skeleton: Skeleton, lengths: NDArray[np.float64]) -> float:
    """Return the greatest distance along the bones between two joints."""
    below, longest = np.zeros(skeleton.n_joints), 0.0
    for joint in range(skeleton.n_joints - 1, 0, -1):
        parent, reach = skeleton.parents[joint], below[joint] + lengths[joint]
        longest = max(longest, below[parent] + reach)
        below[parent] = max(below[parent], reach)
    return longest
