"""Fade weights in and out."""

import numpy as np
from numpy.typing import ArrayLike, NDArray


def smoothstep(values: ArrayLike, start: float = 0.0, stop: float = 1.0) -> NDArray[np.float64]:
    """Map values of any shape smoothly from 0 at `start` and before to 1 from `stop` on.

    `stop` may be less than `start`: small values then have the weight 1.
    """
    fraction = np.clip((np.asarray(values) - start) / (stop - start), 0.0, 1.0)
    return np.asarray(fraction * fraction * (3.0 - 2.0 * fraction))
