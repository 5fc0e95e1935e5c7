"""Align a query with any part of a clip."""

import numpy as np

from ...arrays import Array, Integers

STEP_PENALTY = 1.5
"""Cost factor of a step that advances only one of the two sequences. Chosen by hand;
`make sensitivity` varies it."""


def align_frames(query: Array, clip: Array) -> Integers:
    """Return the best alignment of the complete query with any part of a clip.

    Subsequence dynamic time warping (Müller, Information Retrieval for Music and Motion, 2007,
    section 4.4): start and end in the clip are free. The steps are (1, 1), (1, 0) and (0, 1);
    steps of one sequence alone cost 1.5 times as much, which prevents slow drift.

    Parameters
    ----------
    query, clip : shapes (n, n_features) and (m, n_features)

    Returns
    -------
    shape (n_steps, 2)
        Pairs (frame of the query, frame of the clip).
    """
    distances = np.sqrt(
        np.maximum(
            (query**2).sum(axis=-1)[:, None] + (clip**2).sum(axis=-1) - 2.0 * query @ clip.T,
            0.0,
        )
    )
    costs, penalized = np.empty_like(distances), STEP_PENALTY * distances
    costs[0] = distances[0]
    cumulative = np.cumsum(penalized, axis=-1)
    for row in range(1, len(query)):
        entry = costs[row - 1] + penalized[row]
        entry[1:] = np.minimum(entry[1:], costs[row - 1, :-1] + distances[row, 1:])
        costs[row] = np.minimum.accumulate(entry - cumulative[row]) + cumulative[row]
    return _backtrack_path(costs, distances, penalized)


def _backtrack_path(costs: Array, distances: Array, penalized: Array) -> Integers:
    """Go back from the cheapest end; of equal steps, take that of both sequences."""
    query_only = costs[:-1] + penalized[1:]
    both, clip_only = np.full_like(query_only, np.inf), np.full_like(query_only, np.inf)
    both[:, 1:] = costs[:-1, :-1] + distances[1:, 1:]
    clip_only[:, 1:] = costs[1:, :-1] + penalized[1:, 1:]
    backs_query = np.minimum(query_only, both) <= clip_only
    backs_clip = ~backs_query | (both <= query_only)
    query_steps, clip_steps = backs_query.tobytes(), backs_clip.tobytes()
    n_columns = costs.shape[1]
    row, column = len(costs) - 1, int(costs[-1].argmin())
    path = [(row, column)]
    while row:
        step = (row - 1) * n_columns + column
        row, column = row - query_steps[step], column - clip_steps[step]
        path.append((row, column))
    return np.array(path[::-1], dtype=np.intp)
