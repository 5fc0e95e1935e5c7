"""Dynamic time warping of one sequence with many at a time."""

import numpy as np
from numpy.typing import NDArray

Single = NDArray[np.float32]


def frame_distances(queries: Single, sequences: Single) -> Single:
    """Return how far apart all their moments are.

    Parameters
    ----------
    queries : shape (n_queries, n_steps, n_features)
    sequences : shape (n_sequences, n_frames, n_features)

    Returns
    -------
    shape (n_queries, n_sequences, n_steps, n_frames)
    """
    flat = queries.reshape(-1, queries.shape[-1]), sequences.reshape(-1, sequences.shape[-1])
    squares = [(one**2).sum(axis=-1) for one in flat]
    apart = squares[0][:, None] + squares[1] - 2.0 * flat[0] @ flat[1].T
    np.sqrt(np.maximum(apart, 0.0, out=apart), out=apart)
    return np.asarray(apart.reshape(*queries.shape[:2], *sequences.shape[:2]).swapaxes(1, 2))


def warping_costs(distances: Single) -> Single:
    """Return the least mean distance along a path from first to last frames of both.

    Each row of the dynamic programme is a running minimum: less the cumulative sum of the
    distances along the row, the cost never grows but where a path from above enters.

    Parameters
    ----------
    distances : shape (..., n_steps, n_frames)

    Returns
    -------
    shape (...,)
        Sum along the path, by the sum of both lengths.
    """
    n_steps, n_frames = distances.shape[-2:]
    along = np.cumsum(distances, axis=-1)
    cost = along[..., 0, :]
    for row in range(1, n_steps):
        entered = cost.copy()
        np.minimum(cost[..., 1:], cost[..., :-1], out=entered[..., 1:])
        entered[..., 1:] -= along[..., row, :-1]
        cost = np.minimum.accumulate(entered, axis=-1)
        cost += along[..., row, :]
    return np.asarray(cost[..., -1] / (n_steps + n_frames))
