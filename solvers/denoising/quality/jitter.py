"""Measure the jitter of world positions."""

import numpy as np

from ...arrays import Array


def measure_jitter(positions: Array, frame_rate: float, cuts: tuple[int, ...] = ()) -> Array:
    """Return the mean absolute third difference over time, shape (n_joints,), m/s^3.

    Parameters
    ----------
    positions : shape (n_frames, n_joints, 3), meters; NaN is skipped
    frame_rate : float, hertz
    cuts : tuple of int
        First frames of later segments; no difference spans a cut.
    """
    if len(positions) < 4:
        return np.full(positions.shape[1], np.nan)
    jerk = np.linalg.norm(np.diff(positions, n=3, axis=0), axis=-1) * frame_rate**3
    for cut in cuts:
        jerk[max(cut - 3, 0) : cut] = np.nan
    observed = np.isfinite(jerk)
    total = np.where(observed, jerk, 0.0).sum(axis=0)
    count = observed.sum(axis=0)
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)
