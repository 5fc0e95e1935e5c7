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
    squares = [np.einsum("ij,ij->i", one, one) for one in flat]
    apart = squares[0][:, None] + squares[1] - 2.0 * flat[0] @ flat[1].T
    np.sqrt(np.maximum(apart, 0.0, out=apart), out=apart)
    return np.asarray(apart.reshape(*queries.shape[:2], *sequences.shape[:2]).swapaxes(1, 2))


def warping_costs(distances: Single) -> Single:
    """Return the least mean distance along a path from first to last frames of both.

    The dynamic programme goes along the diagonals, on which no cell waits for another, and
    does all sequences at once.

    Parameters
    ----------
    distances : shape (..., n_steps, n_frames)

    Returns
    -------
    shape (...,)
        Sum along the path, by the sum of both lengths.
    """
    n_steps, n_frames = distances.shape[-2:]
    cells = np.ascontiguousarray(distances.reshape(-1, n_steps * n_frames).T)
    before, last, cost = (
        np.full((n_steps + 1, cells.shape[1]), np.inf, dtype=cells.dtype) for _ in range(3)
    )
    before[0] = 0.0  # What the first cell comes from.
    for diagonal in range(n_steps + n_frames - 1):
        low, high = max(0, diagonal - n_frames + 1), min(n_steps, diagonal + 1)
        rows = np.arange(low, high)
        entered = np.minimum(last[low:high], last[low + 1 : high + 1])
        np.minimum(entered, before[low:high], out=entered)
        cost[low + 1 : high + 1] = entered + cells[rows * n_frames + diagonal - rows]
        cost[: low + 1] = cost[high + 1 :] = np.inf
        before, last, cost = last, cost, before
    return np.asarray(last[-1].reshape(distances.shape[:-2]) / (n_steps + n_frames))
