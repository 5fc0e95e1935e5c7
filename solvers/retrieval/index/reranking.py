"""Clips that are like each other: each tells of the others how like a query they are [1]_.

Neighbours that are so of each other are told more [2]_.

.. [1] Arandjelovic, Zisserman (2012). Three things everyone should know to improve object
   retrieval. CVPR. doi:10.1109/CVPR.2012.6248018
.. [2] Qin, Gammeter, Bossard, Quack, Van Gool (2011). Hello neighbor: accurate object retrieval
   with k-reciprocal nearest neighbors. CVPR.
"""

import numpy as np
from numpy.typing import NDArray

from .time_warping import frame_distances, warping_costs

Single = NDArray[np.float32]

NEIGHBOR_WEIGHT = 4.0
"""How much those that are like a clip count, beside it."""
MAX_DISTANCE_RATIO = 1.2
"""Times its own distance that a clip is moved away at most: the query itself stays near."""
RECIPROCAL_WEIGHT = 3.0
"""How much more those count of which both are among the nearest of the other."""
N_ROUNDS = 2
"""Times that clips tell each other."""
STEP_STRIDE = 2
"""Of the moments of clips, that many-th is compared with those of other clips."""
MAX_CELLS = 1_000_000
"""Of tables of moments by moments, all clips together."""


def pairwise_warping_costs(courses: Single) -> Single:
    """Return how far clips are from each other, shape (n, n), metres: mean along the path.

    Parameters
    ----------
    courses : shape (n, n_steps, n_features)
        What they do at moments evenly spread over their time.
    """
    some = np.ascontiguousarray(courses[:, ::STEP_STRIDE])
    n_clips, n_steps, _ = some.shape
    at_once = max(MAX_CELLS // max(n_clips * n_steps**2, 1), 1)
    rows = [
        warping_costs(frame_distances(some[first : first + at_once], some))
        for first in range(0, n_clips, at_once)
    ]
    return np.concatenate(rows) if rows else np.zeros((0, 0), dtype=np.float32)


def rerank_by_neighbors(apart: Single, between: Single, n_alike: int) -> Single:
    """Return distances from a query that go by those of each clip's nearest as well.

    Parameters
    ----------
    apart : shape (n,)
        From the query.
    between : shape (n, n)
        What its diagonal holds is of no account.
    n_alike : int
        How many of the nearest are asked.
    """
    others = between.copy()
    np.fill_diagonal(others, np.inf)
    farthest = np.partition(others, n_alike - 1, axis=1)[:, n_alike - 1, None]
    nearest = (others <= farthest).astype(np.float32)
    nearest += np.float32(RECIPROCAL_WEIGHT) * nearest * nearest.T
    believed = np.float32(NEIGHBOR_WEIGHT)
    nearest *= believed / nearest.sum(axis=1, keepdims=True)
    told = apart
    for _ in range(N_ROUNDS):
        told = (told + nearest @ told) / (1 + believed)
    return np.minimum(told, np.float32(MAX_DISTANCE_RATIO) * apart)
