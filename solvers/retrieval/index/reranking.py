"""Re-rank clips by the query distances of their nearest neighbors [1]_.

Reciprocal neighbors get a higher weight [2]_.

.. [1] Arandjelovic, Zisserman (2012). Three things everyone should know to improve object
   retrieval. CVPR. doi:10.1109/CVPR.2012.6248018
.. [2] Qin, Gammeter, Bossard, Quack, Van Gool (2011). Hello neighbor: accurate object retrieval
   with k-reciprocal nearest neighbors. CVPR.
"""

import numpy as np

from ...arrays import Single, row_blocks
from .time_warping import frame_distances, warping_costs

NEIGHBOR_WEIGHT = 4.0
"""Total weight of the neighbors of a clip, relative to the clip itself. Chosen by a sweep over
the training data of docs/benchmarks/retrieval.md."""
MAX_DISTANCE_RATIO = 1.2
"""Maximum of the re-ranked distance over the original one: the query itself stays near. Chosen
by hand; `make sensitivity` varies it."""
RECIPROCAL_WEIGHT = 3.0
"""Additional weight of reciprocal neighbors. Chosen by a sweep over the training data of
docs/benchmarks/retrieval.md."""
N_ROUNDS = 2
"""Number of averaging passes. Half and twice are no better (`make sensitivity`)."""
STEP_STRIDE = 2
"""Every n-th time sample of a clip is compared with those of other clips. It bounds the run
time: all samples take four times as long, and change errors by less than 0.2 %."""


def pairwise_warping_costs(sequences: Single) -> Single:
    """Return the warping cost between all clips, shape (n, n), meters: mean along the path.

    Parameters
    ----------
    sequences : shape (n, n_steps, n_features)
        Features at evenly spaced time samples.
    """
    samples = np.ascontiguousarray(sequences[:, ::STEP_STRIDE])
    n_clips, n_steps, _ = samples.shape
    rows = [
        warping_costs(frame_distances(samples[block], samples))
        for block in row_blocks(n_clips, n_clips * n_steps**2)
    ]
    return np.concatenate(rows) if rows else np.zeros((0, 0), dtype=np.float32)


def rerank_by_neighbors(distances: Single, pairwise: Single, n_neighbors: int) -> Single:
    """Average the query distance of each clip with those of its nearest neighbors.

    Parameters
    ----------
    distances : shape (n,)
        Distances from the query.
    pairwise : shape (n, n)
        Distances between the clips; the diagonal is ignored.
    n_neighbors : int
        Number of nearest neighbors.
    """
    masked = pairwise.copy()
    np.fill_diagonal(masked, np.inf)
    limits = np.partition(masked, n_neighbors - 1, axis=1)[:, n_neighbors - 1, None]
    weights = (masked <= limits).astype(np.float32)
    weights += np.float32(RECIPROCAL_WEIGHT) * weights * weights.T
    weight = np.float32(NEIGHBOR_WEIGHT)
    weights *= weight / weights.sum(axis=1, keepdims=True)
    averaged = distances
    for _ in range(N_ROUNDS):
        averaged = (averaged + weights @ averaged) / (1 + weight)
    return np.minimum(averaged, np.float32(MAX_DISTANCE_RATIO) * distances)
