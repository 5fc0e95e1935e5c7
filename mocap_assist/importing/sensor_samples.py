"""Samples of a sensor's joints or markers, on scene frames."""

from typing import NamedTuple

import numpy as np

from ...solvers.arrays import Array

SAME_SAMPLE = 1e-6
"""Relative distance of two samples, in steps between them, that is only rounding, as in
`resample`."""


class SensorSamples(NamedTuple):
    """Values of the sensor."""

    frames: Array
    """Scene frames, shape (n_samples,)."""
    values: dict[str, dict[str, Array]]
    """By joint or marker."""

    def of(self, name: str) -> tuple[Array, dict[str, Array]]:
        """Return the frames and the values of one joint or marker."""
        return self.frames, self.values.get(name, {})

    def on_frames(self, frames: Array) -> "SensorSamples":
        """Return the lower of the two nearest values at each of other frames."""
        between = np.interp(frames, self.frames, np.arange(len(self.frames)))
        nearest = np.round(between)
        between = np.where(np.abs(between - nearest) < SAME_SAMPLE, nearest, between)
        low, high = np.floor(between).astype(int), np.ceil(between).astype(int)
        return SensorSamples(
            frames,
            {
                name: {kind: np.minimum(each[low], each[high]) for kind, each in values.items()}
                for name, values in self.values.items()
            },
        )
