"""Find points that jump away for a few frames, independent of orientation."""

import numpy as np
import scipy
from numpy.typing import NDArray

from ...arrays import Array

COMPARED_FRAMES = (1, 2)
"""Distances in frames, to both sides, at which a point is compared. Half and twice are no
better (`make sensitivity`)."""
NEIGHBORHOOD_FRAMES = 8
"""Half width in frames of the neighborhood that defines the typical distance. Sweep: a half
width of 1 costs 9.8 %, one of 80 gains nothing."""
MIN_SPIKE_RATIO = 6.0
"""Minimum distance of a spike, relative to the typical distance. At 120 Hz the minimum in
meters decides instead. Half and twice gain less than 1 % (`make sensitivity`)."""
MIN_SPIKE_M = 0.02
"""Meters: a shorter distance is not a spike. Half and twice are no better
(`make sensitivity`)."""


def find_transient_outliers(positions: Array) -> NDArray[np.bool_]:
    """Return where points jump away and back, shape (n_frames, n_points).

    Each point is compared with the midpoint between its earlier and later positions. The
    smaller of these distances is small for moving points, and next to a jump of one frame. Next
    to a jump of two frames a good neighbor is classified as an outlier too, at almost no cost.

    Parameters
    ----------
    positions : shape (n_frames, n_points, 3), meters
        NaN where not observed.
    """
    n_frames = len(positions)
    distances = np.full((len(COMPARED_FRAMES), *positions.shape[:2]), np.nan)
    for row, reach in enumerate(COMPARED_FRAMES):
        if n_frames > 2 * reach:
            middle = 0.5 * (positions[: -2 * reach] + positions[2 * reach :])
            distance = np.linalg.norm(positions[reach:-reach] - middle, axis=2)
            distances[row, reach:-reach] = distance
    jump = np.nan_to_num(np.fmin.reduce(distances))  # the smaller one that is observed
    typical_jump = scipy.ndimage.median_filter(
        jump, (2 * NEIGHBORHOOD_FRAMES + 1, 1), mode="nearest"
    )
    return np.asarray(jump > np.maximum(MIN_SPIKE_M, MIN_SPIKE_RATIO * typical_jump))
