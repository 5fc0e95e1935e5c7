"""Detect transient jumps: joints that leave their path for some frames and return."""

import numpy as np

from ...arrays import Array, Flags
from .terms import vector_lengths

MAX_JUMP_S = 0.2
"""Maximum duration (s) of a transient jump. Chosen by hand; `make sensitivity` varies it."""
MIN_JUMP_M = 0.05
"""Minimum step (m) of a jump at any frame rate. It guards recordings of 120 Hz and more:
without it a wobble of 2 cm is a jump
(`test_wobbles_of_two_centimeters_are_no_jumps_at_high_rates`)."""
MIN_ACCELERATION = 100.0
"""Minimum acceleration (m/s²) of a jump, to reach its speed within one frame. Half and twice
are no better (`make sensitivity`)."""
MIN_STEP_RATIO = 3.0
"""Minimum ratio of a jump to the steps before and after it. Half and twice gain less than 1 %
(`make sensitivity`)."""
CONTEXT_S = 0.1
"""Duration (s) of the steps before and after. A joint that jumps more often vibrates. Half and
twice are no better (`make sensitivity`)."""
MAX_RETURN_RATIO = 0.5
"""Maximum distance between start and return position, as a fraction of the jump. Chosen by
hand; `make sensitivity` varies it."""


def find_transient_jumps(positions: Array, frame_rate: float) -> Flags:
    """Return the frames in which joints are away from their path, (n_frames, n_joints).

    A transient jump lies between two jumps within a fifth of a second; the second leads back. A
    jump is a step that no limb can make: far longer than the steps before and after it, and
    with more than 100 m/s². Fast movement meets neither condition.

    Parameters
    ----------
    positions : shape (n_frames, n_joints, 3), meters
    frame_rate : float, hertz
    """
    is_displaced = np.zeros(positions.shape[:2], bool)
    n_frames = len(positions)
    steps = np.zeros(positions.shape[:2])
    steps[1:] = vector_lengths(positions[1:] - positions[:-1])  # into each frame
    step_sizes = np.nan_to_num(steps)
    min_step = max(MIN_JUMP_M, MIN_ACCELERATION / frame_rate**2)
    n_context = max(1, round(CONTEXT_S * frame_rate))
    jumps_away = (step_sizes > min_step) & (
        step_sizes > MIN_STEP_RATIO * _max_before(step_sizes, n_context)
    )
    jumps_back = (step_sizes > min_step) & (
        step_sizes > MIN_STEP_RATIO * _max_before(step_sizes[::-1], n_context)[::-1]
    )
    for n_displaced in range(1, max(1, round(MAX_JUMP_S * frame_rate)) + 1):
        if n_displaced + 1 >= n_frames:
            break
        smaller = np.minimum(step_sizes[1:-n_displaced], step_sizes[n_displaced + 1 :])
        return_distance = vector_lengths(
            positions[n_displaced + 1 :] - positions[: -n_displaced - 1]
        )
        is_transient = (
            jumps_away[1:-n_displaced]
            & jumps_back[n_displaced + 1 :]
            & (return_distance < MAX_RETURN_RATIO * smaller)
        )
        if n_displaced > 1:
            is_transient &= smaller > MIN_STEP_RATIO * np.maximum(
                step_sizes[2 : 1 - n_displaced], step_sizes[n_displaced:-1]
            )
        for offset in range(n_displaced):
            is_displaced[1 + offset : n_frames - n_displaced + offset] |= is_transient
    return is_displaced


def _max_before(steps: Array, n_steps: int) -> Array:
    """Return the maximum of the steps before each, excluding it; 0 for the first."""
    padded = np.concatenate([np.zeros((n_steps, *steps.shape[1:])), steps[:-1]])
    windows = np.lib.stride_tricks.sliding_window_view(padded, n_steps, axis=0)
    return np.asarray(windows.max(axis=-1))
