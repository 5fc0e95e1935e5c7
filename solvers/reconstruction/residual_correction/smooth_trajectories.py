"""Smooth trajectories by penalizing acceleration: over a complete take, or causally."""

from typing import NamedTuple

import numpy as np
import scipy

from ...arrays import Array
from ...signals import second_difference_bands


def smooth_trajectories(positions: Array, weights: Array, frames: float) -> Array:
    """Return the trajectories nearest to the given ones with small accelerations.

    Minimizes sum_t w_t |m_t - z_t|^2 + c sum_t |m_t-1 - 2 m_t + m_t+1|^2 (Whittaker 1923). The
    constant c halves the amplitude of waves of 2 pi `frames` frames where w is 1.

    Parameters
    ----------
    positions : shape (n_frames, n_joints, 3)
        A joint is NaN in every frame or in none.
    weights : shape (n_frames, n_joints), positive
    frames : float
        Time constant in frames.
    """
    n = len(positions)
    if n < 3 or frames <= 0.0:
        return positions.copy()
    bands = frames**4 * second_difference_bands(n)
    result = positions.copy()
    for joint in np.flatnonzero(np.isfinite(positions).all(axis=(0, 2))):
        matrix = bands.copy()
        matrix[2] += weights[:, joint]
        result[:, joint] = scipy.linalg.solveh_banded(
            matrix, weights[:, joint, None] * positions[:, joint], check_finite=False
        )
    return result


class TrajectoryFilter:
    """Smooths trajectories causally, frame by frame.

    The Kalman filter of the model whose smoother is `smooth_trajectories`: velocities change by
    white noise of variance 1 / c, positions are observed with variance 1 / w.

    Parameters
    ----------
    frames : float
        Time constant in frames, as in `smooth_trajectories`.
    """

    def __init__(self, frames: float) -> None:
        self._frames = frames
        self._state: _TrajectoryState | None = None

    def update(self, positions: Array, weights: Array) -> Array:
        """Return the smoothed positions of the next frames; shapes as `smooth_trajectories`."""
        if self._frames <= 0.0:
            return positions.copy()
        result = positions.copy()
        for frame, (position, weight) in enumerate(zip(positions, weights, strict=True)):
            if self._state is None:
                self._state = _TrajectoryState.at_rest(position, weight)
            else:
                self._state = self._state.advance(position, weight, self._frames**-4)
            result[frame] = self._state.position
        return result


class _TrajectoryState(NamedTuple):
    """Position and speed of each joint, with their variances and their covariance."""

    position: Array
    speed: Array
    position_variance: Array
    covariance: Array
    speed_variance: Array

    @classmethod
    def at_rest(cls, position: Array, weight: Array) -> "_TrajectoryState":
        return cls(
            position.copy(), np.zeros_like(position),
            1.0 / weight, np.zeros_like(weight), np.ones_like(weight),
        )  # fmt: skip

    def advance(self, observed: Array, weight: Array, noise: float) -> "_TrajectoryState":
        position = self.position + self.speed
        position_variance = self.position_variance + 2.0 * self.covariance + self.speed_variance
        covariance = self.covariance + self.speed_variance
        speed_variance = self.speed_variance + noise
        gain = 1.0 / (position_variance + 1.0 / weight)
        innovation = (observed - position) * gain[:, None]
        return _TrajectoryState(
            position + position_variance[:, None] * innovation,
            self.speed + covariance[:, None] * innovation,
            position_variance - gain * position_variance**2,
            covariance - gain * position_variance * covariance,
            speed_variance - gain * covariance**2,
        )
