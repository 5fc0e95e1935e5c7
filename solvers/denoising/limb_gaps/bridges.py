"""Describe a gap by how far joints deviate from a straight line across it.

A line from the last frame before the gap to the first one after it needs no mean pose. Every
feature is zero at both ends, so that whatever is added to the line joins the recording.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array

LAG_S = 0.13
"""Seconds before and after a frame at which other joints count, too. Sweep on the development
takes of the first press: without them 1 %, a second pair at 0.27 s 1 % worse."""
VELOCITY_S = 0.07
"""Seconds over which the velocity at either end of the gap is measured. Sweep on the
development takes of the first press: x0.5 costs nothing, x2 costs 0.5 %."""
N_FEATURES = 3
"""Features of each channel, of a missing joint as of an observed one. By definition."""


@dataclass(frozen=True)
class Bridge:
    """A gap with an observed frame on either side.

    Attributes
    ----------
    start, stop : int
        First frame of the gap, and the first one after it.
    frame_rate : float, Hz
    step : int
        Only every so many frames are described.
    """

    start: int
    stop: int
    frame_rate: float
    step: int = 1

    @property
    def frames(self) -> NDArray[np.intp]:
        """The described frames."""
        return np.arange(self.start, self.stop, self.step)

    @property
    def phase(self) -> Array:
        """Position of each described frame between the two observed ones, 0 to 1."""
        return np.asarray((self.frames - self.start + 1) / (self.stop - self.start + 1))

    @property
    def bow(self) -> Array:
        """A parabola over the gap: 0 at its ends, 1 in its middle."""
        return 4.0 * self.phase * (1.0 - self.phase)

    def line(self, values: Array) -> Array:
        """Return the straight line across the gap, shape (n_described, n_channels)."""
        before, after = values[self.start - 1], values[self.stop]
        return np.asarray(before + (after - before) * self.phase[:, None])

    def deviation(self, values: Array) -> Array:
        """Return values (n_frames, n_channels) minus the line."""
        return np.asarray(values[self.frames] - self.line(values))

    def missing_features(self, values: Array) -> Array:
        """Return the features of missing channels from both sides, (n_described, 3,
        n_channels).

        The deviation of a cubic that continues the velocity before the gap; the same for the
        velocity after it; the distance from the mean pose, to which a joint tends to return.
        """
        reach = max(round(VELOCITY_S * self.frame_rate), 1)
        first, last = max(self.start - 1 - reach, 0), min(self.stop + reach, len(values) - 1)
        duration = self.stop - self.start + 1
        before = values[self.start - 1] - values[first]
        after = values[last] - values[self.stop]
        before = duration * before / max(self.start - 1 - first, 1)
        after = duration * after / max(last - self.stop, 1)
        phase = self.phase[:, None]
        return np.stack(
            [
                before * phase * (1.0 - phase) ** 2,
                after * phase**2 * (1.0 - phase),
                self.line(values) * self.bow[:, None],
            ],
            axis=1,
        )

    def observed_features(self, values: Array) -> Array:
        """Return how other channels deviate, shape (n_described, 3, n_channels).

        Their deviation from the line; how it changes from earlier, and to later.
        """
        lag = max(round(LAG_S * self.frame_rate), 1)
        here, last = values[self.frames], len(values) - 1
        changes = [
            (values[np.clip(self.frames + shift, 0, last)] - here) * self.bow[:, None]
            for shift in (-lag, lag)
        ]
        return np.stack([self.deviation(values), *changes], axis=1)
