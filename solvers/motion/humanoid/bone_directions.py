"""Postures as bone directions, which do not depend on the size of the body."""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ..skeletons import MIN_BONE_M
from .posture_joints import N_JOINTS, PARENTS, POSTURE_JOINTS

Real = TypeVar("Real", np.float32, np.float64)

RATE_WINDOW_S = 0.1
"""Seconds to each side over which a rate is measured. It guards high frame rates, at which the
difference of two frames is noise
(`test_noise_of_directions_hardly_changes_rates_at_high_frame_rates`)."""
PARENT_INDICES = np.maximum(PARENTS, 0)
SUBSTITUTES = {"spine": "chest", "chest": "spine", "leftToes": "", "rightToes": ""}
"""Joint whose direction a missing bone takes, if not its parent; empty: forward."""
FORWARD = (0.0, -1.0, 0.0)


def bone_directions(postures: Array) -> Array:
    """Return unit vectors from each joint's parent to it, shape (n_frames, 20, 3).

    That of the hips is zero. A bone that is missing in all frames, as in a body without hands,
    continues its parent; a foot points forward. NaN where a joint is missing in some frames.
    """
    bones = postures - postures[:, PARENT_INDICES]
    lengths = np.linalg.norm(bones, axis=-1, keepdims=True)
    is_long = lengths > MIN_BONE_M
    directions = np.where(is_long, bones, np.nan) / np.where(is_long, lengths, 1.0)
    is_missing = ~np.isfinite(directions).any(axis=(0, 2))
    directions[:, 0] = 0.0
    for joint in range(1, N_JOINTS):
        if is_missing[joint]:
            name = POSTURE_JOINTS[joint]
            substitute = SUBSTITUTES.get(name, POSTURE_JOINTS[PARENTS[joint]])
            directions[:, joint] = (
                directions[:, POSTURE_JOINTS.index(substitute)] if substitute else FORWARD
            )
    return np.asarray(directions)


def rates_from_directions(directions: Array, frame_rate: float) -> Array:
    """Return the rates of change of values, shape (n_frames, ...), per second.

    The slope between the values a tenth of a second before and after; one-sided at the ends.
    """
    n_frames = len(directions)
    half_window = max(round(RATE_WINDOW_S * frame_rate), 1)
    frames = np.arange(n_frames)
    before, after = (
        np.maximum(frames - half_window, 0),
        np.minimum(frames + half_window, n_frames - 1),
    )
    duration = np.maximum(after - before, 1) / frame_rate
    displacements = directions[after] - directions[before]
    return np.asarray(displacements / duration.reshape(-1, *(1,) * (directions.ndim - 1)))


def positions_from_directions(vectors: NDArray[Real], lengths: NDArray[Real]) -> NDArray[Real]:
    """Return joints relative to the hips from directions, or velocities from rates.

    Parameters
    ----------
    vectors : shape (..., 20, 3)
    lengths : shape (20,), meters
    """
    result = np.zeros_like(vectors)
    for joint in range(1, N_JOINTS):
        result[..., joint, :] = (
            result[..., PARENTS[joint], :] + lengths[joint] * vectors[..., joint, :]
        )
    return result
