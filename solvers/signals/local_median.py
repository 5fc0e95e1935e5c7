"""The median of the values around each value."""

import numpy as np

from ..arrays import Array


def local_median(values: Array, half_width: int) -> Array:
    """Return the median over so many values on each side, shape (n,).

    Beyond both ends the outer values repeat, as in `scipy.ndimage.median_filter` in its mode
    "nearest", which takes longer to import.
    """
    padded = np.pad(values, half_width, mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * half_width + 1)
    return np.asarray(np.median(windows, axis=-1))
