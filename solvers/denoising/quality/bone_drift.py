"""Lengths that should not change, and by how much they do."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import minimum_spanning_tree

from ...motion import Tracks
from ...motion.humanoid import roles_by_name
from ..feet import SIDES

Array = NDArray[np.float64]

MAX_SAMPLED_FRAMES = 1000
"""Frames looked at to decide which points are rigidly connected; the drift uses them all."""
LENGTH_COST = 0.01
"""Of two equally steady connections the shorter one is the likelier bone."""
LOW_PERCENTILE, HIGH_PERCENTILE = 5.0, 95.0
MAX_LENGTH_VARIATION = 0.1
"""Part of its length by which a bone's middle half may vary."""
MIN_NAMED_BONES = 6
"""Fewer bones known by name are no body."""


@dataclass(frozen=True)
class BoneDrift:
    """How much the distance of two points that should be rigidly connected changes."""

    first: str
    second: str
    length: float
    """Median distance, metres."""
    drift: float
    """Span that holds 90 % of all distances, metres."""


def measure_bone_drifts(tracks: Tracks) -> tuple[BoneDrift, ...]:
    """Find the points that are connected like a bone, and measure the drift of the lengths.

    Points that are called like the joints of a body are connected like its limbs and its neck.
    Other points, such as markers, are connected by the minimum spanning tree of how much the
    distances vary (Kirk, O'Brien and Forsyth 2005, doi:10.1109/CVPR.2005.326), of which the
    connections that are steady most of the time are kept. Points that are never seen together
    are not connected.
    """
    pairs = _bones_from_names(tracks.names) or _bones_from_distances(tracks)
    drifts = [_drift(tracks, first, second) for first, second in pairs]
    return tuple(drift for drift in drifts if drift is not None)


def _bones_from_names(names: tuple[str, ...]) -> list[tuple[int, int]]:
    """Return pairs of points whose names say that a bone is between them; none if few do."""
    roles = roles_by_name(names)
    index_of_role = {role: names.index(name) for role, name in roles.items()}
    chains = [["neck", "head"]]
    for side in SIDES:
        chains.append([f"{side}{role}" for role in ("UpperLeg", "LowerLeg", "Foot", "Toes")])
        chains.append([f"{side}{role}" for role in ("UpperArm", "LowerArm", "Hand")])
    pairs = [
        (index_of_role[upper], index_of_role[lower])
        for chain in chains
        for upper, lower in pairwise(chain)
        if upper in index_of_role and lower in index_of_role
    ]
    return pairs if len(pairs) >= MIN_NAMED_BONES else []


def _bones_from_distances(tracks: Tracks) -> list[tuple[int, int]]:
    sample = tracks.positions[:: max(1, tracks.n_frames // MAX_SAMPLED_FRAMES)]
    n_points = tracks.n_points
    costs, constant = np.zeros((n_points, n_points)), np.zeros((n_points, n_points), dtype=bool)
    for point in range(n_points - 1):
        distances = np.linalg.norm(sample[:, point + 1 :] - sample[:, point, None], axis=-1)
        for other, lengths in enumerate(distances.T, start=point + 1):
            costs[point, other], constant[point, other] = _cost(lengths[np.isfinite(lengths)])
    tree = minimum_spanning_tree(costs).tocoo()
    pairs = sorted((int(a), int(b)) for a, b in zip(tree.row, tree.col, strict=True))
    return [(min(pair), max(pair)) for pair in pairs if constant[min(pair), max(pair)]]


def _cost(lengths: Array) -> tuple[float, bool]:
    """Unsteadiness plus a little for the length, 0 if never seen; and whether it is steady."""
    if not len(lengths):
        return 0.0, False
    low, quarter, median, three_quarters, high = np.percentile(
        lengths, (LOW_PERCENTILE, 25.0, 50.0, 75.0, HIGH_PERCENTILE)
    )
    constant = three_quarters - quarter <= MAX_LENGTH_VARIATION * median
    return float(high - low + LENGTH_COST * median + 1e-9), bool(constant)


def _drift(tracks: Tracks, first: int, second: int) -> BoneDrift | None:
    lengths = np.linalg.norm(tracks.positions[:, first] - tracks.positions[:, second], axis=-1)
    lengths = lengths[np.isfinite(lengths)]
    if not len(lengths):
        return None
    low, median, high = np.percentile(lengths, (LOW_PERCENTILE, 50.0, HIGH_PERCENTILE))
    names = tracks.names
    return BoneDrift(names[first], names[second], float(median), float(high - low))
