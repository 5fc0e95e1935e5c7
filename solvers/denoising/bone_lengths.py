"""Lengths that should not change, and by how much they do."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import minimum_spanning_tree

from ..motion import Tracks

Array = NDArray[np.float64]

MOST_FRAMES = 1000
"""Frames looked at to decide which points are rigidly connected; the drift uses them all."""
PER_LENGTH = 0.01
"""Of two equally steady connections the shorter one is the likelier bone."""
LOW, HIGH = 5.0, 95.0


@dataclass(frozen=True)
class BoneDrift:
    """How much the distance of two points that should be rigidly connected changes."""

    first: str
    second: str
    length: float
    """Median distance, metres."""
    drift: float
    """Span that holds 90 % of all distances, metres."""


def bone_drifts(tracks: Tracks) -> tuple[BoneDrift, ...]:
    """Find the points that are connected like a bone, and measure the drift of the lengths.

    The connections are the minimum spanning tree of how much the distances vary (Kirk, O'Brien
    and Forsyth 2005, doi:10.1109/CVPR.2005.326): no names and no skeleton are needed. Points
    that are never seen together are not connected.
    """
    sample = tracks.positions[:: max(1, tracks.n_frames // MOST_FRAMES)]
    n_points = tracks.n_points
    weights = np.zeros((n_points, n_points))
    for point in range(n_points - 1):
        away = np.linalg.norm(sample[:, point + 1 :] - sample[:, point, None], axis=-1)
        weights[point, point + 1 :] = _cost(away)
    tree = minimum_spanning_tree(weights).tocoo()
    pairs = sorted(
        tuple(sorted((int(a), int(b)))) for a, b in zip(tree.row, tree.col, strict=True)
    )
    return tuple(_drift(tracks, first, second) for first, second in pairs)


def _cost(distances: Array) -> Array:
    """Unsteadiness of each column plus a little for its length; 0 (no edge) if never seen."""
    cost = np.zeros(distances.shape[1])
    for column, seen in enumerate(distances.T):
        seen = seen[np.isfinite(seen)]
        if len(seen):
            low, middle, high = np.percentile(seen, (LOW, 50.0, HIGH))
            cost[column] = high - low + PER_LENGTH * middle + 1e-9
    return cost


def _drift(tracks: Tracks, first: int, second: int) -> BoneDrift:
    lengths = np.linalg.norm(tracks.positions[:, first] - tracks.positions[:, second], axis=-1)
    low, middle, high = np.percentile(lengths[np.isfinite(lengths)], (LOW, 50.0, HIGH))
    return BoneDrift(
        tracks.names[first], tracks.names[second], float(middle), float(high - low)
    )
