"""The path of one person, and how far a new observation is from it."""

import numpy as np

from ...arrays import Array

MAX_VELOCITY_GAP_S = 0.25
"""Duration in seconds between frames up to which they have a velocity. It guards against the
mean velocity of a long gap."""


class PersonPath:
    """Where a person was last, and how the joints moved there.

    Parameters
    ----------
    points : shape (n_joints, 3), in the unit of the file, NaN where not observed
    time : float, seconds
    """

    def __init__(self, points: Array, time: float) -> None:
        self.time = time
        self._points = points
        self._velocity: Array | None = None

    def add(self, points: Array, time: float) -> None:
        """Continue the path."""
        gap = time - self.time
        is_near = 0.0 < gap <= MAX_VELOCITY_GAP_S and points.shape == self._points.shape
        velocity = (points - self._points) / gap if is_near else None
        self.time, self._points, self._velocity = time, points, velocity

    def distance(self, points: Array, time: float) -> float:
        """Return the mean distance of joints from where they were, or would be by now."""
        held = mean_distance(points, self._points)
        if self._velocity is None:
            return held
        predicted = self._points + (time - self.time) * self._velocity
        return min(held, mean_distance(points, predicted))


def mean_distance(one: Array, other: Array) -> float:
    """Return the mean distance between equal joints, or between centers without any.

    Parameters
    ----------
    one, other : shape (n_joints, 3), NaN where not observed
    """
    if one.shape == other.shape:
        distances = np.linalg.norm(one - other, axis=1)
        distances = distances[np.isfinite(distances)]
        if len(distances):
            return float(distances.mean())
    return float(np.linalg.norm(center(one) - center(other)))


def center(points: Array) -> Array:
    """Return the mean of the observed points, shape (3,)."""
    observed = points[np.isfinite(points).all(axis=1)]
    return np.asarray(observed.mean(axis=0))
