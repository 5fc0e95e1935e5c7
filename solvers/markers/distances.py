"""How far markers are from those that move along with them: what tells one from another."""

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
NEIGHBOURS = 6
LEAST_SPREAD = 0.004
"""Metres: a distance is never held to be known better."""
FIRM = 0.02
"""Metres by which a distance varies at most that alone tells a marker."""
MOST_FRAMES = 400
FEWEST_FRAMES = 30
GREATEST_SURPRISE = 8.0
NORMAL = 1.4826
"""Standard deviations in a median absolute deviation of a normal distribution."""


@dataclass(frozen=True, eq=False)
class Distances:
    """What distances between markers usually are."""

    usual: Array
    """Medians, shape (n_markers, n_markers), metres; NaN where two are hardly seen together."""
    spread: Array
    """Robust standard deviations of the same, metres."""

    def neighbours(self, marker: int, without: tuple[int, ...] = ()) -> NDArray[np.intp]:
        """Return the markers whose distance to one varies least."""
        spread = self.spread[marker].copy()
        spread[[marker, *without]] = np.nan
        order = np.argsort(spread, kind="stable")
        return np.asarray(order[np.isfinite(spread[order])][:NEIGHBOURS])

    def firm_neighbours(self, marker: int, without: tuple[int, ...] = ()) -> NDArray[np.intp]:
        """Return those neighbours whose distance hardly varies."""
        near = self.neighbours(marker, without)
        return np.asarray(near[self.spread[marker, near] <= FIRM])

    def surprise(
        self, marker: int, places: Array, others: Array, near: NDArray[np.intp]
    ) -> Array:
        """Return how odd it is to find a marker at these places, shape (n_frames,).

        Half the squared deviation of its distances to neighbours, in units of their spread, on
        average and bounded; NaN where no neighbour is seen.

        Parameters
        ----------
        marker : int
        places : shape (n_frames, 3), metres
        others : shape (n_frames, n_markers, 3), metres
        near : the neighbours to ask
        """
        apart = np.linalg.norm(places[:, None] - others[:, near], axis=-1)
        odd = (apart - self.usual[marker, near]) / self.spread[marker, near]
        return nan_mean(np.minimum(0.5 * odd**2, GREATEST_SURPRISE))


def learn_distances(positions: Array) -> Distances:
    """Learn the usual distances between markers of a take, most of whose labels are right.

    Parameters
    ----------
    positions : shape (n_frames, n_markers, 3), metres
    """
    step = max(1, len(positions) // MOST_FRAMES)
    some = positions[::step]
    n_markers = positions.shape[1]
    usual, spread = np.full((2, n_markers, n_markers), np.nan)
    enough = min(FEWEST_FRAMES, max(1, len(some) // 2))
    for marker in range(n_markers):
        apart = np.linalg.norm(some - some[:, [marker]], axis=-1)
        middle = nan_median(apart)
        usual[marker] = middle
        spread[marker] = NORMAL * nan_median(np.abs(apart - middle))
        few = np.isfinite(apart).sum(axis=0) < enough
        usual[marker, few] = spread[marker, few] = np.nan
    np.fill_diagonal(spread, np.nan)
    return Distances(usual, np.maximum(spread, LEAST_SPREAD))


def nan_median(values: Array) -> Array:
    """Return medians over the first axis without NaN; NaN where there is nothing else."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of all-NaN columns
        return np.asarray(np.nanmedian(values, axis=0))


def nan_mean(values: Array) -> Array:
    """Return means over the last axis without NaN; NaN where there is nothing else."""
    known = np.isfinite(values)
    count = known.sum(axis=-1)
    total = np.where(known, values, 0.0).sum(axis=-1)
    return np.asarray(np.where(count > 0, total / np.maximum(count, 1), np.nan))
