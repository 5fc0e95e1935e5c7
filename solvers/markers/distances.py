"""Distances between neighboring markers, which identify a marker."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..signals import MAD_TO_SIGMA
from .rigid_transform import MARKER_NOISE_M
from .vectors import nan_median

MAX_NEIGHBORS = 6
"""Number of markers, those at the most constant distance, that a label is compared with. Half
and twice are no better (`make sensitivity`)."""
RIGID_SPREAD_M = 0.02
"""Maximum spread of a distance that identifies a marker by itself. It guards markers that move
freely, any of whose distances are those of another one at times."""
MAX_FRAMES = 400
"""Frames, evenly spaced, from which distances are learned. It bounds the run time."""
MIN_OBSERVED_FRACTION = 0.2
"""Minimum fraction of frames with both markers of a pair. It guards a marker seen in a few
frames, in which no distance has time to vary: it would join a cluster."""
MAX_MISFIT = 8.0
"""Maximum squared error of one distance, relative to its spread, over two: it limits outliers.
Half and twice are no better (`make sensitivity`)."""


@dataclass(frozen=True, eq=False)
class Distances:
    """Statistics of the distances between markers."""

    median: Array
    """Medians, shape (n_markers, n_markers), meters; NaN for rarely observed pairs."""
    spread: Array
    """Robust standard deviations of the same, meters."""

    def neighbors(self, marker: int, without: tuple[int, ...] = ()) -> NDArray[np.intp]:
        """Return the markers whose distance to one varies least."""
        spread = self.spread[marker].copy()
        spread[[marker, *without]] = np.nan
        order = np.argsort(spread, kind="stable")
        return np.asarray(order[np.isfinite(spread[order])][:MAX_NEIGHBORS])

    def rigid_neighbors(self, marker: int, without: tuple[int, ...] = ()) -> NDArray[np.intp]:
        """Return the neighbors with nearly constant distance."""
        neighbors = self.neighbors(marker, without)
        return np.asarray(neighbors[self.spread[marker, neighbors] <= RIGID_SPREAD_M])

    def misfit(
        self, marker: int, positions: Array, others: Array, neighbors: NDArray[np.intp]
    ) -> Array:
        """Return the misfit of a marker at these positions, shape (n_frames,).

        The bounded mean of half the squared deviations of its distances to neighbors, in units
        of their spread; NaN without observed neighbors.

        Parameters
        ----------
        marker : int
        positions : shape (n_frames, 3), meters
        others : shape (n_frames, n_markers, 3), meters
        neighbors : indices of the neighbors
        """
        separation = np.linalg.norm(positions[:, None] - others[:, neighbors], axis=-1)
        deviation = (separation - self.median[marker, neighbors]) / self.spread[
            marker, neighbors
        ]
        return nan_mean(np.minimum(0.5 * deviation**2, MAX_MISFIT))


def learn_distances(positions: Array) -> Distances:
    """Learn the distances between markers of a take with mostly correct labels.

    Parameters
    ----------
    positions : shape (n_frames, n_markers, 3), meters
    """
    step = max(1, len(positions) // MAX_FRAMES)
    sample = positions[::step]
    n_markers = positions.shape[1]
    median, spread = np.full((2, n_markers, n_markers), np.nan)
    enough = max(1.0, MIN_OBSERVED_FRACTION * len(sample))
    for marker in range(n_markers):
        separation = np.linalg.norm(sample - sample[:, [marker]], axis=-1)
        middle = nan_median(separation)
        median[marker] = middle
        spread[marker] = MAD_TO_SIGMA * nan_median(np.abs(separation - middle))
        few = np.isfinite(separation).sum(axis=0) < enough
        median[marker, few] = spread[marker, few] = np.nan
    np.fill_diagonal(spread, np.nan)
    return Distances(median, np.maximum(spread, MARKER_NOISE_M))


def nan_mean(values: Array) -> Array:
    """Return means of values, (..., n), over the last axis without NaN; NaN if all are NaN."""
    valid = np.isfinite(values)
    count = valid.sum(axis=-1)
    total = np.where(valid, values, 0.0).sum(axis=-1)
    return np.asarray(np.where(count > 0, total / np.maximum(count, 1), np.nan))
