"""Keep labels by continuity alone: what most tracking programs begin with."""

import numpy as np
from scipy.optimize import linear_sum_assignment

from solvers.arrays import Array

UNASSIGNED_COST_M = 10.0
"""Meters: the cost of a label that gets no point."""


def by_continuity(positions: Array) -> Array:
    """Assign each frame's points to the labels with the nearest predicted positions.

    A position is predicted by constant velocity from the last two frames in which a label had a
    point, and the sum of distances made small (Kuhn's assignment). Whatever a frame's own
    labels say is ignored.

    Parameters
    ----------
    positions : shape (n_frames, n_markers, 3), meters; NaN where not observed
    """
    result = positions.copy()
    last, step = positions[0].copy(), np.zeros_like(positions[0])
    for frame in range(1, len(positions)):
        expected = last + step
        cost = np.linalg.norm(expected[:, None] - positions[frame][None], axis=-1)
        labels, points = linear_sum_assignment(np.nan_to_num(cost, nan=UNASSIGNED_COST_M))
        result[frame, labels] = positions[frame, points]
        observed = np.isfinite(result[frame]).all(axis=-1)
        step = np.where(observed[:, None], np.nan_to_num(result[frame] - last), 0.0)
        last = np.where(observed[:, None], result[frame], last)
    return result
