"""The penalty of acceleration, for banded linear systems over time."""

import numpy as np
from numpy.typing import NDArray


def second_difference_bands(n_frames: int) -> NDArray[np.float64]:
    """Return D'D, where D takes second differences over time, as LAPACK's upper bands.

    Shape (3, n_frames): the second and the first superdiagonal, then the diagonal; zeros for
    fewer than three frames.
    """
    bands = np.zeros((3, n_frames))
    if n_frames > 2:
        bands[0, 2:] = 1.0
        bands[1, 1:-1] -= 2.0
        bands[1, 2:] -= 2.0
        for first, square in enumerate((1.0, 4.0, 1.0)):
            bands[2, first : n_frames - 2 + first] += square
    return bands
