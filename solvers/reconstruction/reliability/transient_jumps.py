"""Joints that jump away for some frames and come back: that tells nothing of other frames."""

import numpy as np
from numpy.typing import NDArray

from .terms import vector_lengths

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

MAX_JUMP_S = 0.2
"""Seconds that a joint may be away."""
MIN_JUMP_M = 0.05
"""Metres that it must jump at least, however soon frames follow each other."""
MIN_ACCELERATION = 100.0
"""Metres per second squared: a joint that reaches its speed in a frame that way is thrown."""
MIN_STEP_RATIO = 3.0
"""How often as far a jump is as the steps before and after it."""
CONTEXT_S = 0.1
"""Seconds of steps before and after; what jumps more often is not only away, but unsteady."""
MAX_RETURN_RATIO = 0.5
"""It comes back at most this share of the jump away from where it was."""


def find_transient_jumps(positions: Array, frame_rate: float) -> Flags:
    """Tell in which frames joints are away from their path, shape (n_frames, n_joints).

    Away is what lies between two jumps that follow each other within a fifth of a second, of
    which the second leads back. A jump is a step that no limb can make: far longer than those
    before and after it, and with more than 100 m/s^2. Fast movement has neither.

    Parameters
    ----------
    positions : shape (n_frames, n_joints, 3), metres
    frame_rate : float, hertz
    """
    away = np.zeros(positions.shape[:2], bool)
    n_frames = len(positions)
    steps = np.zeros(positions.shape[:2])
    steps[1:] = vector_lengths(positions[1:] - positions[:-1])  # into each frame
    outer = np.nan_to_num(steps)
    far = max(MIN_JUMP_M, MIN_ACCELERATION / frame_rate**2)
    calm = max(1, round(CONTEXT_S * frame_rate))
    leaves = (outer > far) & (outer > MIN_STEP_RATIO * _max_before(outer, calm))
    returns = (outer > far) & (outer > MIN_STEP_RATIO * _max_before(outer[::-1], calm)[::-1])
    for n_away in range(1, max(1, round(MAX_JUMP_S * frame_rate)) + 1):
        if n_away + 1 >= n_frames:
            break
        least = np.minimum(outer[1:-n_away], outer[n_away + 1 :])
        apart = vector_lengths(positions[n_away + 1 :] - positions[: -n_away - 1])
        there = leaves[1:-n_away] & returns[n_away + 1 :] & (apart < MAX_RETURN_RATIO * least)
        if n_away > 1:
            there &= least > MIN_STEP_RATIO * np.maximum(
                outer[2 : 1 - n_away], outer[n_away:-1]
            )
        for place in range(n_away):
            away[1 + place : n_frames - n_away + place] |= there
    return away


def _max_before(steps: Array, n_steps: int) -> Array:
    """Return the greatest of the steps just before each, without it; 0 for the first."""
    padded = np.concatenate([np.zeros((n_steps, *steps.shape[1:])), steps[:-1]])
    windows = np.lib.stride_tricks.sliding_window_view(padded, n_steps, axis=0)
    return np.asarray(windows.max(axis=-1))
