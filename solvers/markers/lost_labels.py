"""Find markers that carry the label of one that is lost."""

import numpy as np
from numpy.typing import NDArray

from .distances import Distances, nan_median
from .pair_swaps import PairSwap

Array = NDArray[np.float64]
ODD, WELL = 4.0, 1.0
"""Median surprise from which on a label does not fit, and up to which it does."""
FEWEST_NEIGHBOURS = 3
JUMP = 0.06
"""Metres a marker moves against its neighbours in one frame, if it is another from there on."""


def mistaken_runs(positions: Array, distances: Distances) -> list[PairSwap]:
    """Return the stretches in which a marker has the label of another that is lost.

    A stretch lies between gaps or jumps of the label. It must fit the distances of the lost
    marker well, and its own badly; or fit those better, and begin or end where that was.
    """
    lost = ~np.isfinite(positions).all(axis=-1)
    found = []
    for marker in range(positions.shape[1]):
        near = distances.neighbours(marker)
        if len(near) < FEWEST_NEIGHBOURS:
            continue
        for start, stop in _stretches(positions, marker, near):
            free = np.flatnonzero(lost[start:stop].all(axis=0))
            if not len(free) or stop - start == len(positions):
                continue
            fits = [
                (_gain(positions, (marker, int(other)), (start, stop), distances), int(other))
                for other in free
            ]
            gain, other = max(fits)
            if gain > 0.0:
                found.append(PairSwap(gain, marker, other, start, stop))
    return _apart(sorted(found, reverse=True))


def _gain(
    positions: Array, pair: tuple[int, int], stretch: tuple[int, int], distances: Distances
) -> float:
    """Return how much better the second label fits a stretch of the first; 0 if unsure."""
    first, second = pair
    some = slice(*stretch)
    handed = _handed_over(positions, pair, stretch)
    near = [
        distances.neighbours(one, (other,))
        if handed
        else distances.firm_neighbours(one, (other,))
        for one, other in ((first, second), (second, first))
    ]
    own, fit = (
        _oddness(positions[some], label, first, nearest, distances)
        for label, nearest in zip(pair, near, strict=True)
    )
    if (handed and fit < own) or (own > ODD and fit < WELL):
        return own - fit
    return 0.0


def _oddness(
    positions: Array,
    label: int,
    marker: int,
    near: NDArray[np.intp],
    distances: Distances,
) -> float:
    """Return how odd a marker is, over a stretch, under a label; NaN if unknown."""
    there = np.isfinite(positions[:, near]).all(axis=-1).sum(axis=1)
    if np.median(there) < FEWEST_NEIGHBOURS:
        return np.nan
    return _median(distances.surprise(label, positions[:, marker], positions, near))


def _handed_over(positions: Array, pair: tuple[int, int], stretch: tuple[int, int]) -> bool:
    """Whether the first marker is, where the stretch begins or ends, where the second was."""
    first, second = pair
    for inside, outside in ((stretch[0], stretch[0] - 1), (stretch[1] - 1, stretch[1])):
        if not 0 <= outside < len(positions):
            continue
        to_other = np.linalg.norm(positions[inside, first] - positions[outside, second])
        to_own = np.linalg.norm(positions[inside, first] - positions[outside, first])
        if to_other < JUMP / 2 and not to_own < 2.0 * to_other:
            return True
    return False


def _median(values: Array) -> float:
    return float(nan_median(values[:, None])[0])


def _stretches(positions: Array, marker: int, near: NDArray[np.intp]) -> list[tuple[int, int]]:
    """Return first and last-but-one frames of what may be one marker all along."""
    seen = np.isfinite(positions[:, marker]).all(axis=-1)
    relative = positions[:, [marker]] - positions[:, near]
    step = nan_median(np.linalg.norm(np.diff(relative, axis=0), axis=-1).T)
    begins = seen.copy()
    begins[1:] &= ~seen[:-1] | (np.nan_to_num(step) > JUMP)
    ends = np.append(~seen[1:] | begins[1:], True) & seen
    starts, stops = np.flatnonzero(begins), np.flatnonzero(ends) + 1
    return [(int(a), int(b)) for a, b in zip(starts, stops, strict=True)]


def _apart(found: list[PairSwap]) -> list[PairSwap]:
    """Leave out what would give one label twice in one frame."""
    kept: list[PairSwap] = []
    for one in found:
        clash = any(
            other.second == one.second and other.start < one.stop and one.start < other.stop
            for other in kept
        )
        if not clash:
            kept.append(one)
    return kept
