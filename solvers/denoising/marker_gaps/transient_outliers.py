"""Points that jump away for a few frames, found the same from whatever side they are seen."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

Array = NDArray[np.float64]

REACH = (1, 2)
"""Frames to both sides that a point is compared with."""
AROUND = 8
"""Frames to both sides that say what is usual."""
USUAL = 6.0
"""Times as far as usual is a jump."""
SMALLEST = 0.02
"""Metres: nothing nearer is one."""


def stray(positions: Array) -> NDArray[np.bool_]:
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
    away = np.full((len(REACH), *positions.shape[:2]), np.nan)
    for place, reach in enumerate(REACH):
        if n_frames > 2 * reach:
            middle = 0.5 * (positions[: -2 * reach] + positions[2 * reach :])
            apart = np.linalg.norm(positions[reach:-reach] - middle, axis=2)
            away[place, reach:-reach] = apart
    found = np.nan_to_num(np.fmin.reduce(away))  # the lesser that is known
    usual = median_filter(found, (2 * AROUND + 1, 1), mode="nearest")
    return np.asarray(found > np.maximum(SMALLEST, USUAL * usual))
