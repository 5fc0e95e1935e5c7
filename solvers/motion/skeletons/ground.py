"""The height of the ground under a body."""

import numpy as np

from ...arrays import Array

GROUND_WINDOW_S = 0.5
"""Seconds before and after a frame in which the lower foot stands. It guards feet that
swing in the air (`test_stances_of_a_fifth_of_a_second_keep_their_length`)."""
MAX_CLIMB_M = 0.3
"""Maximum height of ground above the lowest of the take. It guards feet that hang or rest in
the air (`test_hanging_feet_have_no_contact`)."""


def ground_level(lowest: Array, frame_rate: float) -> Array:
    """Return the height of the ground in each frame, shape (n_frames,), meters.

    It is the highest level within a second above which the lowest point stays for a second: a
    foot on a box is on the ground if the other one follows.

    Parameters
    ----------
    lowest : shape (n_frames,), meters, for a leg of 0.9 m
        Height of the lowest point, such as the lower foot.
    frame_rate : float, hertz
    """
    from scipy.ndimage import maximum_filter1d, minimum_filter1d  # slow to import

    window = round(GROUND_WINDOW_S * frame_rate)
    level = minimum_filter1d(lowest, 2 * window + 1, mode="nearest")
    level = maximum_filter1d(level, 4 * window + 1, mode="nearest")
    return np.asarray(np.minimum(level, level.min() + MAX_CLIMB_M))
