"""What a residual prior says of postures, and between them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Prediction:
    """What a prior says of postures.

    Attributes
    ----------
    offsets : shape (n_frames, 20, 3), metres
        True minus seen place, in the frame of the heading; 0 for joints that were not learned.
    variances : shape (n_frames, 20), square metres for each axis
        Of what the shared functions do not know; infinite for joints that were not learned.
    coverage : shape (n_frames, 20), 0 to 1
        How near the posture is to those that were learned.
    """

    offsets: Array
    variances: Array
    coverage: Array


def interpolate_prediction(told: Prediction, frames: NDArray[np.intp]) -> Prediction:
    """Return what is told of all frames, along straight lines between those that are told."""
    every = np.arange(frames[-1] + 1)
    after = np.searchsorted(frames, every)
    before = np.maximum(after - 1, 0)
    share = (frames[after] - every) / np.maximum(frames[after] - frames[before], 1)

    def led(values: Array) -> Array:
        part = share.reshape(-1, *[1] * (values.ndim - 1))
        return np.asarray(part * values[before] + (1.0 - part) * values[after])

    known = np.isfinite(told.variances)
    variances = led(np.where(known, told.variances, 0.0))
    variances[:, ~known.all(axis=0)] = np.inf
    return Prediction(led(told.offsets), variances, led(told.coverage))
