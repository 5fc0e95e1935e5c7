"""The extra depth term: closest-point pairs for pixels that cannot be compared."""

import numpy as np
import scipy

from ...arrays import Array, Integers
from ..body import NO_ROWS, SurfaceRows, rows_toward_targets
from .hypothesis import Hypothesis
from .observation import Observation
from .pixel_groups import PixelGroups


def extra_depth_term(
    hypothesis: Hypothesis,
    observation: Observation,
    groups: PixelGroups,
    weight: float,
    limit: float,
) -> SurfaceRows:
    """Return the rows of the extra depth term of [WZC12]_, eq. 5 and 17: four types of pairs.

    Visible points off the actor (type 1) or in front of what was observed (type 3) are pushed
    to the closest observed point; observed points that the body does not cover (type 2) or that
    lie in front of it (type 4) pull the closest visible point. One-to-one: of the pairs of a
    type that share a point, the shortest stays. Pairs whose depths differ by more than `limit`
    are left out.

    Parameters
    ----------
    hypothesis : Hypothesis
    observation : Observation
    groups : PixelGroups
    weight : float, per square meter
        1 / sigma^2 of one pair.
    limit : float, meters
    """
    if not (len(hypothesis.points) and len(observation.points)):
        return NO_ROWS
    pushed_points = np.concatenate([groups.off_actor, groups.too_near])
    behind = hypothesis.image.pixels[groups.too_far]
    pulling = observation.index_image[np.concatenate([groups.uncovered, behind])]
    rendered_tree = scipy.spatial.cKDTree(
        hypothesis.points, balanced_tree=False, compact_nodes=False
    )
    pushes = _one_to_one(
        pushed_points, *observation.tree.query(hypothesis.points[pushed_points])
    )
    pulls = _one_to_one(pulling, *rendered_tree.query(observation.points[pulling]))
    moved = np.concatenate([pushes[0], pulls[1]])
    targets = observation.points[np.concatenate([pushes[1], pulls[0]])]
    near = np.abs(hypothesis.points[moved, 2] - targets[:, 2]) <= limit
    moved, targets = moved[near], targets[near]
    return rows_toward_targets(
        hypothesis.points[moved], targets, np.full(len(moved), weight),
        hypothesis.image.capsules[moved],
    )  # fmt: skip


def _one_to_one(
    sources: Integers, distances: Array, targets: Integers
) -> tuple[Integers, Integers]:
    """Keep the shortest of the pairs that share a target."""
    order = np.lexsort((distances, targets))
    first = np.ones(len(order), dtype=bool)
    first[1:] = targets[order][1:] != targets[order][:-1]
    shortest = order[first]
    return sources[shortest], targets[shortest]
