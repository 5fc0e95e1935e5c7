"""Decide foot contacts while an actor moves, from the frames so far."""

from collections import deque

import numpy as np

from ..arrays import Array
from ..motion.humanoid import CONTACT_MODEL, SPEED_NOISE, FeetInMotion
from ..motion.skeletons import GROUND_WINDOW_S, MAX_CLIMB_M
from ..signals import TwoStateFilter

MAX_LINE_S = 0.15
"""Maximum duration, seconds, of the frames from which a speed is measured. It bounds the delay
of contacts in noisy streams to half of it, and the weight of a single frame after dropped
ones."""


class RunningLine:
    """Position and speed of points, from a line through the last frames.

    White noise of deviation s moves a line through n frames at s sqrt(12 / (n (n^2 - 1))) per
    frame. The line has as few frames as keep this below `SPEED_NOISE`.

    Parameters
    ----------
    frame_rate : float, hertz
    noise : float
        Deviation of the noise along each axis, in the unit of the points.
    max_speed_noise : float
        In that unit per second.
    """

    def __init__(self, frame_rate: float, noise: float, max_speed_noise: float) -> None:
        counts = np.arange(2, max(2, int(MAX_LINE_S * frame_rate)) + 1)
        speed_noise = noise * frame_rate * np.sqrt(12.0 / (counts * (counts**2 - 1.0)))
        enough = np.flatnonzero(speed_noise <= max_speed_noise)
        chosen = enough[0] if len(enough) else len(counts) - 1
        self.speed_noise = float(speed_noise[chosen])
        """Deviation of the speed along each axis."""
        self.duration = float(counts[chosen] - 1) / frame_rate
        """Seconds from the first to the last frame of the line."""
        self._times: deque[float] = deque(maxlen=int(counts[chosen]))
        self._points: deque[Array] = deque(maxlen=int(counts[chosen]))

    def update(self, points: Array, elapsed_s: float) -> tuple[Array, Array]:
        """Return the mean positions and the velocities; 0 in the first frame.

        Parameters
        ----------
        points : shape (..., 3)
        elapsed_s : float, seconds since the last frame
        """
        self._times.append((self._times[-1] if self._times else 0.0) + elapsed_s)
        self._points.append(points)
        stacked = np.stack(self._points)
        mean = stacked.mean(axis=0)
        times = np.array(self._times) - np.mean(self._times)
        if len(times) == 1:
            return mean, np.zeros_like(points)
        return mean, np.tensordot(times, stacked - mean, 1) / (times @ times)

    def restart(self) -> None:
        """Forget the frames so far."""
        self._times.clear()
        self._points.clear()


class LiveContacts:
    """The probability of foot contact by the model of `contact_probabilities`, frame by frame.

    Where that model needs later frames, this one looks back: speeds are those of a line through
    the last frames, the ground is the highest level of the last two seconds above which the
    lower foot stayed for one, and the hidden Markov model is filtered forward only. So contacts
    begin and end a few frames late at most. The ground is at most `MAX_CLIMB_M` above the
    lowest ground of the last two seconds: a floor that is higher counts three seconds after the
    step onto it, and a single low frame does not count.

    Parameters
    ----------
    frame_rate : float, hertz
    size : float
        Length of a leg over 0.9 m.
    noise : float, meters
        Deviation of the points' noise along each axis.
    """

    def __init__(self, frame_rate: float, size: float = 1.0, noise: float = 0.0) -> None:
        self._size = size
        self._line = RunningLine(frame_rate, noise / size, SPEED_NOISE)
        window = round(GROUND_WINDOW_S * frame_rate)
        self._lower: deque[Array] = deque(maxlen=2 * window + 1)
        self._levels: deque[Array] = deque(maxlen=4 * window + 1)
        self._grounds: deque[Array] = deque(maxlen=4 * window + 1)
        self._filter = _contact_filter()

    def update(self, points: Array, elapsed_s: float) -> Array:
        """Return the probability that the left and the right foot are in contact, shape (2,).

        Parameters
        ----------
        points : shape (2, 2, 3), meters
            Left and right, ankle and toes.
        elapsed_s : float, seconds since the last frame
        """
        positions, velocities = self._line.update(points / self._size, elapsed_s)
        speeds = np.sqrt(
            np.maximum(np.sum(velocities**2, axis=-1) - 3.0 * self._line.speed_noise**2, 0.0)
        )
        heights = positions[..., 2] - self._ground(positions[..., 2].min(axis=0))
        feet = FeetInMotion(
            np.ones((1, 2, 2), dtype=np.bool_),
            speeds[None],
            heights[None],
            self._line.duration,
            min(elapsed_s, MAX_LINE_S),
        )
        return self._filter.update(feet.evidence(CONTACT_MODEL)[0], elapsed_s)

    def restart(self) -> None:
        """Forget the frames so far, as after a gap or with another actor."""
        self._line.restart()
        for past in (self._lower, self._levels, self._grounds):
            past.clear()
        self._filter = _contact_filter()

    def _ground(self, lower: Array) -> Array:
        """Return the level of the ground for ankles and for toes, shape (2,)."""
        self._lower.append(lower)
        self._levels.append(np.min(self._lower, axis=0))
        self._grounds.append(np.max(self._levels, axis=0))
        lowest = np.min(self._grounds, axis=0)
        return np.asarray(np.minimum(self._grounds[-1], lowest + MAX_CLIMB_M))


def _contact_filter() -> TwoStateFilter:
    return TwoStateFilter(CONTACT_MODEL.landing_rate, CONTACT_MODEL.lift_rate)
