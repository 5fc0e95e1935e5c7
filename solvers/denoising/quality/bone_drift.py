"""Measure how much lengths that should be constant change."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...arrays import Array
from ...motion import Tracks
from ...motion.humanoid import SIDES, roles_by_name

MAX_SAMPLED_FRAMES = 1000
"""Frames used to decide which points are rigidly connected; the drift uses all frames. It
bounds the run time of long takes."""
MAX_POINTS = 300
"""Points without names of joints that are tested in pairs. It bounds the run time: 45,000 pairs
take 12 to 24 seconds in a long take, and a thousand points took minutes."""
LENGTH_COST = 0.01
"""Cost per meter: of two equally constant connections the shorter one is preferred. Half and
twice gain less than 1 % (`make sensitivity`)."""
LOW_PERCENTILE, HIGH_PERCENTILE = 5.0, 95.0
"""Percentiles of all distances between which a length drifts: 90 % of them, by definition of
the drift."""
MAX_LENGTH_VARIATION = 0.1
"""Interquartile range of a bone's length, relative to its length. Chosen by hand;
`make sensitivity` varies it."""
MIN_NAMED_BONES = 6
"""With fewer named bones, the names are not those of a body. It guards takes of markers with
one or two names of a body (`test_bones_are_found_and_their_drift_measured`)."""


@dataclass(frozen=True)
class BoneDrift:
    """Variation of the distance between two points that should be rigidly connected."""

    first: str
    second: str
    length: float
    """Median distance, meters."""
    drift: float
    """Range that contains 90 % of all distances, meters."""


def measure_bone_drifts(tracks: Tracks) -> tuple[BoneDrift, ...]:
    """Find rigidly connected points, and measure the drift of their distances.

    Points named like the joints of a body are connected like its limbs and its neck. Other
    points, such as markers, are connected by the minimum spanning tree of how much their
    distances vary (Kirk, O'Brien and Forsyth 2005, doi:10.1109/CVPR.2005.326). Only connections
    with a nearly constant length are kept. Points without a common observed frame are not
    connected, and none where `bones_are_searched` is False.
    """
    pairs = _bones_from_names(tracks.names)
    if not pairs and bones_are_searched(tracks):
        pairs = _bones_from_distances(tracks)
    drifts = [_drift(tracks, first, second) for first, second in pairs]
    return tuple(drift for drift in drifts if drift is not None)


def bones_are_searched(tracks: Tracks) -> bool:
    """Return whether the names imply bones, or the points are at most `MAX_POINTS`."""
    return tracks.n_points <= MAX_POINTS or bool(_bones_from_names(tracks.names))


def _bones_from_names(names: tuple[str, ...]) -> list[tuple[int, int]]:
    """Return pairs of points whose names imply a bone between them; none if few do."""
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
    from scipy.sparse.csgraph import minimum_spanning_tree  # slow: only when needed

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
    """Return the variation plus a small cost of length (0 without data), and if it is
    constant."""
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
