"""Linear and angular velocities by finite differences."""

import numpy as np
from numpy.typing import NDArray

from ...rotations import inverse, multiply, rotation_vector_from_quaternion


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
    return _from_steps(np.diff(positions, axis=0), np.isfinite(positions), frame_rate)


def angular_velocities(
    rotations: NDArray[np.float64], frame_rate: float
) -> NDArray[np.float64]:
    """Return the angular velocity at each frame, by the method of `linear_velocities`.

    Parameters
    ----------
    rotations : shape (n_frames, ..., 4), unit quaternions w x y z
        Each step is the shortest rotation between two frames.
    frame_rate : float, hertz

    Returns
    -------
    NDArray, shape (n_frames, ..., 3), radians per second
        In the parent's axes for local rotations, in the world's axes for world rotations.
    """
    steps = rotation_vector_from_quaternion(multiply(rotations[1:], inverse(rotations[:-1])))
    return _from_steps(steps, np.isfinite(rotations[..., 1:]), frame_rate)


def _from_steps(
    steps: NDArray[np.float64], observed: NDArray[np.bool_], frame_rate: float
) -> NDArray[np.float64]:
    """Average the valid steps into and out of each frame."""
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
