"""Points that jump away for a few frames, found the same from whatever side they are seen."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

Array = NDArray[np.float64]

COMPARED_FRAMES = (1, 2)
"""Frames to both sides that a point is compared with."""
NEIGHBORHOOD_FRAMES = 8
"""Frames to both sides that say what is usual."""
MIN_SPIKE_RATIO = 6.0
"""Times as far as usual is a jump."""
MIN_SPIKE_M = 0.02
"""Metres: nothing nearer is one."""


def find_transient_outliers(positions: Array) -> NDArray[np.bool_]:
    """Return where points jump away, shape (n_frames, n_points).

    A point is compared with the middles between where it was and where it will be; the
    lesser of these distances is small for what moves, and beside a jump of one frame. Beside
    one of two frames a good neighbour is called stray too, which costs next to nothing.

    Parameters
    ----------
    positions : shape (n_frames, n_points, 3), metres
        NaN where not observed.
    """
    n_frames = len(positions)
    distances = np.full((len(COMPARED_FRAMES), *positions.shape[:2]), np.nan)
    for row, reach in enumerate(COMPARED_FRAMES):
        if n_frames > 2 * reach:
            middle = 0.5 * (positions[: -2 * reach] + positions[2 * reach :])
            distance = np.linalg.norm(positions[reach:-reach] - middle, axis=2)
            distances[row, reach:-reach] = distance
    jump = np.nan_to_num(np.fmin.reduce(distances))  # the lesser that is known
    typical_jump = median_filter(jump, (2 * NEIGHBORHOOD_FRAMES + 1, 1), mode="nearest")
    return np.asarray(jump > np.maximum(MIN_SPIKE_M, MIN_SPIKE_RATIO * typical_jump))
