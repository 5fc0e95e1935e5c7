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


def mistaken_runs(
    positions: Array, distances: Distances, frame_rate: float
) -> list[PairSwap]:
    """Return the stretches in which a marker has the label of another that is lost.

    A stretch lies between gaps or jumps of the label. All of it must fit the lost marker's
    distances well, and its own badly.
    """
    lost = ~np.isfinite(positions).all(axis=-1)
    found = []
    for marker in range(positions.shape[1]):
        near = distances.firm_neighbours(marker)
        if len(near) < FEWEST_NEIGHBOURS:
            continue
        surprise = distances.surprise(marker, positions[:, marker], positions, near)
        for start, stop in _stretches(positions, marker, near):
            if not _median(surprise[start:stop]) > ODD:
                continue
            free = np.flatnonzero(lost[start:stop].all(axis=0))
            fits = [
                (_fit(positions[start:stop], marker, int(other), distances), int(other))
                for other in free
            ]
            best = min(fits, default=(np.inf, -1))
            if best[0] < WELL:
                found.append(PairSwap(0.0, marker, best[1], start, stop))
    return _apart(found)


def _fit(positions: Array, marker: int, other: int, distances: Distances) -> float:
    """Return how odd a marker is, over a stretch, if it is another; infinite if unknown."""
    near = distances.firm_neighbours(other, (marker,))
    there = np.isfinite(positions[:, near]).all(axis=-1).sum(axis=1)
    if np.median(there) < FEWEST_NEIGHBOURS:
        return np.inf
    fit = _median(distances.surprise(other, positions[:, marker], positions, near))
    return fit if np.isfinite(fit) else np.inf


def _median(values: Array) -> float:
    return float(nan_median(values[:, None])[0])


def _stretches(
    positions: Array, marker: int, near: NDArray[np.intp]
) -> list[tuple[int, int]]:
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
