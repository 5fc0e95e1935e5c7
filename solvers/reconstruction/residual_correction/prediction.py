"""Predictions of a residual prior, and their interpolation in time."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array


@dataclass(frozen=True, eq=False)
class Prediction:
    """Predicted errors of a sensor in given poses.

    Attributes
    ----------
    offsets : shape (n_frames, 20, 3), meters
        True minus observed position, relative to the heading; 0 for joints without a model.
    variances : shape (n_frames, 20), square meters for each axis
        Uncertainty of the shared functions; infinite for joints without a model.
    coverage : shape (n_frames, 20), 0 to 1
        Similarity of the pose to the training data.
    """

    offsets: Array
    variances: Array
    coverage: Array

    def halves(self) -> tuple["Prediction", "Prediction"]:
        """Return the first half of the frames, and the second."""
        offsets, variances, coverage = (
            np.split(each, 2) for each in (self.offsets, self.variances, self.coverage)
        )
        first, second = map(Prediction, offsets, variances, coverage)
        return first, second


def interpolate_prediction(prediction: Prediction, frames: NDArray[np.intp]) -> Prediction:
    """Interpolate predictions of some frames, (n,) increasing indices, linearly to all."""
    all_frames = np.arange(frames[-1] + 1)
    after = np.searchsorted(frames, all_frames)
    before = np.maximum(after - 1, 0)
    fraction = (frames[after] - all_frames) / np.maximum(frames[after] - frames[before], 1)

    def interpolate(values: Array) -> Array:
        weight = fraction.reshape(-1, *[1] * (values.ndim - 1))
        return np.asarray(weight * values[before] + (1.0 - weight) * values[after])

    is_known = np.isfinite(prediction.variances)
    variances = interpolate(np.where(is_known, prediction.variances, 0.0))
    variances[:, ~is_known.all(axis=0)] = np.inf
    return Prediction(
        interpolate(prediction.offsets), variances, interpolate(prediction.coverage)
    )
