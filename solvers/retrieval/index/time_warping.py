"""Dynamic time warping of many pairs of sequences at once."""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ...arrays import Single


def frame_distances(queries: Single, sequences: Single) -> Single:
    """Return the distances between all frames of queries and sequences.

    Parameters
    ----------
    queries : shape (n_queries, n_steps, n_features)
    sequences : shape (n_sequences, n_frames, n_features)

    Returns
    -------
    shape (n_steps, n_frames, n_queries, n_sequences)
    """
    by_step = [np.ascontiguousarray(array.swapaxes(0, 1)) for array in (queries, sequences)]
    flat = [array.reshape(-1, array.shape[-1]) for array in by_step]
    squares = [np.einsum("ij,ij->i", array, array) for array in flat]
    distances = flat[0] @ flat[1].T
    distances *= np.float32(-2.0)
    distances += squares[0][:, None]
    distances += squares[1]
    np.sqrt(np.maximum(distances, 0.0, out=distances), out=distances)
    return np.asarray(
        distances.reshape(*by_step[0].shape[:2], *by_step[1].shape[:2]).swapaxes(1, 2)
    )


def warping_costs(distances: Single) -> Single:
    """Return the minimum mean distance along a path from the first to the last frames.

    The dynamic program advances along the anti-diagonals, on which the cells are independent,
    for all sequences at once.

    Parameters
    ----------
    distances : shape (n_steps, n_frames, ...)

    Returns
    -------
    shape (...,)
        Sum along the path divided by the sum of both lengths.
    """
    n_steps, n_frames = distances.shape[:2]
    cells = distances.reshape(n_steps * n_frames, -1)[_diagonals(n_steps, n_frames)]
    before, last, cost = np.full((3, n_steps + 2, cells.shape[1]), np.inf, dtype=cells.dtype)
    buffer = np.empty_like(cost)
    before[0] = 0.0  # predecessor of the first cell
    done = 0
    for diagonal in range(n_steps + n_frames - 1):
        low, high = max(0, diagonal - n_frames + 1), min(n_steps, diagonal + 1)
        minima = np.minimum(last[low:high], last[low + 1 : high + 1], out=buffer[low:high])
        np.minimum(minima, before[low:high], out=minima)
        np.add(minima, cells[done : done + high - low], out=cost[low + 1 : high + 1])
        cost[low] = cost[high + 1] = np.inf  # border of the next diagonals
        before, last, cost = last, cost, before
        done += high - low
    return np.asarray(last[n_steps].reshape(distances.shape[2:]) / (n_steps + n_frames))


@lru_cache(maxsize=8)
def _diagonals(n_steps: int, n_frames: int) -> NDArray[np.intp]:
    """Return the indices of the cells of a table in the order of its anti-diagonals."""
    rows, columns = np.indices((n_steps, n_frames)).reshape(2, -1)
    return np.asarray(np.lexsort([rows, rows + columns]))
