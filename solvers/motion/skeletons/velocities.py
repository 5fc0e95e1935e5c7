"""Velocities by finite differences."""

import numpy as np
from numpy.typing import NDArray


def linear_velocities(positions: NDArray[np.float64], frame_rate: float) -> NDArray[np.float64]:
    """Return the velocity at each frame by central differences.

    Parameters
    ----------
    positions : shape (n_frames, ..., 3), meters
    frame_rate : float, hertz

    Returns
    -------
    NDArray, shape (n_frames, ..., 3), meters per second
        Exact for constant acceleration. One-sided at the ends and next to gaps. NaN where the
        point is missing or has no observed neighbor; zero for a recording of one frame.
    """
    steps, observed = np.diff(positions, axis=0), np.isfinite(positions)
    if not len(steps):
        return np.where(observed, 0.0, np.nan)
    known = np.isfinite(steps)
    steps = np.where(known, steps, 0.0)
    total = np.zeros(observed.shape)
    count = np.zeros(observed.shape)
    for side in (slice(1, None), slice(None, -1)):
        total[side] += steps
        count[side] += known
    return np.asarray(frame_rate * total / np.where(count > 0.0, count, np.nan))
