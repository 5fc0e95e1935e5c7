"""Paths near given places whose accelerations are small: over a whole take, or as it comes."""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

Array = NDArray[np.float64]


def smooth_trajectories(positions: Array, weights: Array, frames: float) -> Array:
    """Return the paths nearest to the given ones whose accelerations are small.

    Minimises sum_t w_t |m_t - z_t|^2 + c sum_t |m_t-1 - 2 m_t + m_t+1|^2 (Whittaker 1923);
    c is chosen so that waves of 2 pi `frames` frames lose half their size where w is 1.

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
    bands = frames**4 * _second_differences(n)
    result = positions.copy()
    for joint in np.flatnonzero(np.isfinite(positions).all(axis=(0, 2))):
        matrix = bands.copy()
        matrix[2] += weights[:, joint]
        result[:, joint] = solveh_banded(
            matrix, weights[:, joint, None] * positions[:, joint], check_finite=False
        )
    return result


def filter_trajectories(positions: Array, weights: Array, frames: float) -> Array:
    """Return the same as it comes: each frame knows what was before it, and nothing else.

    The Kalman filter of the model whose smoother `smoothed` is: velocities change by white
    noise of variance 1 / c, places are seen with variance 1 / w.

    Parameters
    ----------
    positions, weights, frames : as of `smoothed`
    """
    if frames <= 0.0:
        return positions.copy()
    result = positions.copy()
    place, speed = positions[0].copy(), np.zeros_like(positions[0])
    own = 1.0 / weights[0]  # variances of place and speed, and their covariance
    both, rate = np.zeros_like(own), np.ones_like(own)
    for frame in range(1, len(positions)):
        place = place + speed
        own = own + 2.0 * both + rate
        both = both + rate
        rate = rate + frames**-4
        gain = 1.0 / (own + 1.0 / weights[frame])
        new = (positions[frame] - place) * gain[:, None]
        place, speed = place + own[:, None] * new, speed + both[:, None] * new
        rate = rate - gain * both**2
        both = both - gain * own * both
        own = own - gain * own**2
        result[frame] = place
    return result


def _second_differences(n: int) -> Array:
    """Return the bands of D'D, D the second differences of n frames, as LAPACK wants them."""
    bands = np.zeros((3, n))
    if n <= 5:
        rough = np.diff(np.eye(n), 2, axis=0)
        for lag in range(3):
            bands[2 - lag, lag:] = np.diagonal(rough.T @ rough, lag)
        return bands
    bands[0, 2:] = 1.0
    bands[1, 1:] = [-2.0, *[-4.0] * (n - 3), -2.0]
    bands[2] = [1.0, 5.0, *[6.0] * (n - 4), 5.0, 1.0]
    return bands
