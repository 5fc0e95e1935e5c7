"""Dynamic time warping of one sequence with many at a time, or of many with many."""

from functools import lru_cache

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
    shape (n_steps, n_frames, n_queries, n_sequences)
    """
    turned = [np.ascontiguousarray(one.swapaxes(0, 1)) for one in (queries, sequences)]
    flat = [one.reshape(-1, one.shape[-1]) for one in turned]
    squares = [np.einsum("ij,ij->i", one, one) for one in flat]
    apart = flat[0] @ flat[1].T
    apart *= np.float32(-2.0)
    apart += squares[0][:, None]
    apart += squares[1]
    np.sqrt(np.maximum(apart, 0.0, out=apart), out=apart)
    return np.asarray(apart.reshape(*turned[0].shape[:2], *turned[1].shape[:2]).swapaxes(1, 2))


def warping_costs(distances: Single) -> Single:
    """Return the least mean distance along a path from first to last frames of both.

    The dynamic programme goes along the diagonals, on which no cell waits for another, and
    does all sequences at once.

    Parameters
    ----------
    distances : shape (n_steps, n_frames, ...)

    Returns
    -------
    shape (...,)
        Sum along the path, by the sum of both lengths.
    """
    n_steps, n_frames = distances.shape[:2]
    cells = distances.reshape(n_steps * n_frames, -1)[_diagonals(n_steps, n_frames)]
    before, last, cost = np.full((3, n_steps + 2, cells.shape[1]), np.inf, dtype=cells.dtype)
    entered = np.empty_like(cost)
    before[0] = 0.0  # What the first cell comes from.
    done = 0
    for diagonal in range(n_steps + n_frames - 1):
        low, high = max(0, diagonal - n_frames + 1), min(n_steps, diagonal + 1)
        least = np.minimum(last[low:high], last[low + 1 : high + 1], out=entered[low:high])
        np.minimum(least, before[low:high], out=least)
        np.add(least, cells[done : done + high - low], out=cost[low + 1 : high + 1])
        cost[low] = cost[high + 1] = np.inf  # All that the next diagonals see beside these.
        before, last, cost = last, cost, before
        done += high - low
    return np.asarray(last[n_steps].reshape(distances.shape[2:]) / (n_steps + n_frames))


@lru_cache(maxsize=8)
def _diagonals(n_steps: int, n_frames: int) -> NDArray[np.intp]:
    """Return the cells of a table, row by row, in the order of its diagonals from below."""
    rows, columns = np.indices((n_steps, n_frames)).reshape(2, -1)
    return np.asarray(np.lexsort([rows, rows + columns]))
