"""Smooth trajectories by penalizing acceleration: over a complete take, or causally."""

import numpy as np
from scipy.linalg import solveh_banded

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
        result[:, joint] = solveh_banded(
            matrix, weights[:, joint, None] * positions[:, joint], check_finite=False
        )
    return result


def filter_trajectories(positions: Array, weights: Array, frames: float) -> Array:
    """Return causally smoothed trajectories: each frame depends on earlier frames only.

    The Kalman filter of the model whose smoother is `smooth_trajectories`: velocities change by
    white noise of variance 1 / c, positions are observed with variance 1 / w.

    Parameters
    ----------
    positions, weights, frames : as in `smooth_trajectories`
    """
    if frames <= 0.0:
        return positions.copy()
    result = positions.copy()
    position, speed = positions[0].copy(), np.zeros_like(positions[0])
    position_variance = 1.0 / weights[0]  # of position and speed, with their covariance
    covariance, speed_variance = (
        np.zeros_like(position_variance),
        np.ones_like(position_variance),
    )
    for frame in range(1, len(positions)):
        position = position + speed
        position_variance = position_variance + 2.0 * covariance + speed_variance
        covariance = covariance + speed_variance
        speed_variance = speed_variance + frames**-4
        gain = 1.0 / (position_variance + 1.0 / weights[frame])
        innovation = (positions[frame] - position) * gain[:, None]
        position, speed = (
            position + position_variance[:, None] * innovation,
            speed + covariance[:, None] * innovation,
        )
        speed_variance = speed_variance - gain * covariance**2
        covariance = covariance - gain * position_variance * covariance
        position_variance = position_variance - gain * position_variance**2
        result[frame] = position
    return result
