"""Find markers with the label of a missing marker."""

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from .distances import Distances
from .pair_swaps import PairSwap
from .vectors import nan_median

MIN_BAD_MISFIT = 4.0
"""Median misfit, relative to the spread of the distances, above which a label is wrong. Half
and twice are no better (`make sensitivity`)."""
MAX_GOOD_MISFIT = 1.0
"""Median misfit, relative to the same, below which a label is correct. It guards reflections,
which fit no label (`test_reflection_does_not_get_the_label_of_a_missing_marker`)."""
MIN_NEIGHBORS = 3
"""Number of observed neighbors without which no label is checked: spheres about three of them
meet in two points. Half and twice are no better (`make sensitivity`)."""
MIN_JUMP_M = 0.06
"""Step relative to the neighbors in one frame that indicates another marker. It guards markers
that get the label of a missing one for some frames: they would keep it."""


def find_mistaken_labels(positions: Array, distances: Distances) -> list[PairSwap]:
    """Return the intervals in which a marker has the label of a missing one.

    An interval is between gaps or jumps of the label. It must fit the distances of the missing
    marker well and its own badly; or fit the former better and start or end at its position.
    `positions` has the shape (n_frames, n_markers, 3), meters.
    """
    missing = ~np.isfinite(positions).all(axis=-1)
    swaps = []
    for marker in range(positions.shape[1]):
        neighbors = distances.neighbors(marker)
        if len(neighbors) < MIN_NEIGHBORS:
            continue
        for start, stop in _intervals(positions, marker, neighbors):
            free = np.flatnonzero(missing[start:stop].all(axis=0))
            if not len(free) or stop - start == len(positions):
                continue
            fits = [
                (_gain(positions, (marker, int(other)), (start, stop), distances), int(other))
                for other in free
            ]
            gain, other = max(fits)
            if gain > 0.0:
                swaps.append(PairSwap(gain, marker, other, start, stop))
    return _without_duplicates(sorted(swaps, reverse=True))


def _gain(
    positions: Array, pair: tuple[int, int], interval: tuple[int, int], distances: Distances
) -> float:
    """Return the gain of the second label in an interval of the first; 0 if uncertain."""
    first, second = pair
    frames = slice(*interval)
    handed = _handed_over(positions, pair, interval)
    neighbors = [
        distances.neighbors(one, (other,))
        if handed
        else distances.rigid_neighbors(one, (other,))
        for one, other in ((first, second), (second, first))
    ]
    own, fit = (
        _misfit(positions[frames], label, first, nearest, distances)
        for label, nearest in zip(pair, neighbors, strict=True)
    )
    if (handed and fit < own) or (own > MIN_BAD_MISFIT and fit < MAX_GOOD_MISFIT):
        return own - fit
    return 0.0


def _misfit(
    positions: Array,
    label: int,
    marker: int,
    neighbors: NDArray[np.intp],
    distances: Distances,
) -> float:
    """Return the median misfit of a marker with a label in an interval; NaN if unknown."""
    n_observed = np.isfinite(positions[:, neighbors]).all(axis=-1).sum(axis=1)
    if np.median(n_observed) < MIN_NEIGHBORS:
        return np.nan
    return _median(distances.misfit(label, positions[:, marker], positions, neighbors))


def _handed_over(positions: Array, pair: tuple[int, int], interval: tuple[int, int]) -> bool:
    """Return whether the first marker starts or ends the interval at the second's position."""
    first, second = pair
    for inside, outside in ((interval[0], interval[0] - 1), (interval[1] - 1, interval[1])):
        if not 0 <= outside < len(positions):
            continue
        to_other = np.linalg.norm(positions[inside, first] - positions[outside, second])
        to_own = np.linalg.norm(positions[inside, first] - positions[outside, first])
        if to_other < MIN_JUMP_M / 2 and not to_own < 2.0 * to_other:
            return True
    return False


def _median(values: Array) -> float:
    return float(nan_median(values[:, None])[0])


def _intervals(
    positions: Array, marker: int, neighbors: NDArray[np.intp]
) -> list[tuple[int, int]]:
    """Return (start, stop) of the intervals without gaps and jumps of a marker."""
    observed = np.isfinite(positions[:, marker]).all(axis=-1)
    relative = positions[:, [marker]] - positions[:, neighbors]
    step = nan_median(np.linalg.norm(np.diff(relative, axis=0), axis=-1).T)
    begins = observed.copy()
    begins[1:] &= ~observed[:-1] | (np.nan_to_num(step) > MIN_JUMP_M)
    ends = np.append(~observed[1:] | begins[1:], True) & observed
    starts, stops = np.flatnonzero(begins), np.flatnonzero(ends) + 1
    return [(int(a), int(b)) for a, b in zip(starts, stops, strict=True)]


def _without_duplicates(swaps: list[PairSwap]) -> list[PairSwap]:
    """Remove changes that would assign one label twice in a frame."""
    accepted: list[PairSwap] = []
    for one in swaps:
        clash = any(
            other.second == one.second and other.start < one.stop and one.start < other.stop
            for other in accepted
        )
        if not clash:
            accepted.append(one)
    return accepted
