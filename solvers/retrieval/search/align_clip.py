"""Which frames of a clip belong to which of a query that is found somewhere in it."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Path = NDArray[np.intp]

STEP_PENALTY = 1.5
"""What a step costs in which one of both stands still."""


def align_frames(query: Array, clip: Array) -> Path:
    """Return the best path of the whole query through any part of a clip.

    Subsequence dynamic time warping (Müller, Information Retrieval for Music and Motion, 2007,
    section 4.4): beginning and end in the clip are free. Steps (1, 1), (1, 0) and (0, 1);
    those that stand still in one of them cost half as much again, lest a path creeps.

    Parameters
    ----------
    query, clip : shapes (n, n_features) and (m, n_features)

    Returns
    -------
    shape (n_steps, 2)
        Pairs (frame of the query, frame of the clip).
    """
    apart = np.sqrt(
        np.maximum(
            (query**2).sum(axis=-1)[:, None] + (clip**2).sum(axis=-1) - 2.0 * query @ clip.T,
            0.0,
        )
    )
    costs, still = np.empty_like(apart), STEP_PENALTY * apart
    costs[0] = apart[0]
    along = np.cumsum(still, axis=-1)
    for row in range(1, len(query)):
        entered = costs[row - 1] + still[row]
        entered[1:] = np.minimum(entered[1:], costs[row - 1, :-1] + apart[row, 1:])
        costs[row] = np.minimum.accumulate(entered - along[row]) + along[row]
    return _backtrack_path(costs, apart, still)


def _backtrack_path(costs: Array, apart: Array, still: Array) -> Path:
    row, column = len(costs) - 1, int(costs[-1].argmin())
    path = [(row, column)]
    while row:
        ways = [(costs[row - 1, column] + still[row, column], row - 1, column)]
        if column:
            ways.append((costs[row - 1, column - 1] + apart[row, column], row - 1, column - 1))
            ways.append((costs[row, column - 1] + still[row, column], row, column - 1))
        _, row, column = min(ways)
        path.append((row, column))
    return np.array(path[::-1], dtype=np.intp)
