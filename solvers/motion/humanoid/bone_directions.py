"""Postures as directions of bones, which tell nothing of how large a body is."""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from .posture_joints import N_JOINTS, PARENTS, POSTURE_JOINTS

Array = NDArray[np.float64]
Real = TypeVar("Real", np.float32, np.float64)

SHORT = 5e-3
"""Metres. A bone that is shorter tells no direction."""
REACH = 0.1
"""Seconds to both sides over which a change is measured."""
PARENT_INDICES = np.maximum(PARENTS, 0)
STANDS_FOR = {"spine": "chest", "chest": "spine", "leftToes": "", "rightToes": ""}
"""Whose direction a bone without one has, where it is not that of the joint above."""
FORWARD = (0.0, -1.0, 0.0)


def bone_directions(postures: Array) -> Array:
    """Return unit vectors from the joint above to each joint, shape (n_frames, 20, 3).

    The hips' is zero. A bone that is never told, as in a body without hands, goes on as the one
    above it, and a foot forward. NaN where a joint is not told in one frame only.
    """
    bones = postures - postures[:, PARENT_INDICES]
    sizes = np.linalg.norm(bones, axis=-1, keepdims=True)
    long = sizes > SHORT
    directions = np.where(long, bones, np.nan) / np.where(long, sizes, 1.0)
    never = ~np.isfinite(directions).any(axis=(0, 2))
    directions[:, 0] = 0.0
    for joint in range(1, N_JOINTS):
        if never[joint]:
            name = POSTURE_JOINTS[joint]
            other = STANDS_FOR.get(name, POSTURE_JOINTS[PARENTS[joint]])
            directions[:, joint] = (
                directions[:, POSTURE_JOINTS.index(other)] if other else FORWARD
            )
    return np.asarray(directions)


def rates_from_directions(directions: Array, frame_rate: float) -> Array:
    """Return how directions, or whatever else goes on in time, change per second.

    The slope between the values a tenth of a second before and after; at the ends, between
    those that there are.
    """
    n_frames = len(directions)
    reach = max(round(REACH * frame_rate), 1)
    frames = np.arange(n_frames)
    before, after = np.maximum(frames - reach, 0), np.minimum(frames + reach, n_frames - 1)
    time = np.maximum(after - before, 1) / frame_rate
    ways = directions[after] - directions[before]
    return np.asarray(ways / time.reshape(-1, *(1,) * (directions.ndim - 1)))


def positions_from_directions(vectors: NDArray[Real], lengths: NDArray[Real]) -> NDArray[Real]:
    """Return joints relative to the hips from directions, or speeds from changes.

    Parameters
    ----------
    vectors : shape (..., 20, 3)
    lengths : shape (20,), metres
    """
    result = np.zeros_like(vectors)
    for joint in range(1, N_JOINTS):
        result[..., joint, :] = (
            result[..., PARENTS[joint], :] + lengths[joint] * vectors[..., joint, :]
        )
    return result
