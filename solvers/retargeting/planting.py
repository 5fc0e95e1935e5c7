"""Let feet slide over the ground no more than the source's."""

import numpy as np
from numpy.typing import NDArray

from ..signals import smooth_correction

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Foot = tuple[Array, Array]
"""Ankle and ball, each of shape (n_frames, 3), metres."""

BLEND = 0.3
"""Seconds over which the correction of a planted foot fades."""
STRICTNESS = 8.0
"""Power of the speeds whose ratio tells whether the ankle or the ball stands."""
STILL = 1e-9


def planting_shift(
    theirs: Foot, ours: Foot, stands: Flags, growth: float, frame_rate: float
) -> Array:
    """Return by how much the ankle must move for the foot to slide as the source's, grown.

    What stands is the slower of the source's ankle and ball. From frame to frame, the same
    point of the target goes as far; the smoothest shift that does that is the result.

    Parameters
    ----------
    theirs, ours : Foot
        Of the source; and of the target without the shift.
    stands : bool, shape (n_frames,)
    growth : float
        Over the ground.
    frame_rate : float, hertz

    Returns
    -------
    NDArray, shape (n_frames, 3), metres
        Level; fades before and after each contact.
    """
    shift = np.zeros_like(ours[0])
    held = stands[1:] & stands[:-1]
    if not held.any():
        return shift
    source, target = (
        [np.diff(point[:, :2], axis=0) for point in foot] for foot in (theirs, ours)
    )
    ankle, ball = (np.linalg.norm(step, axis=1) + STILL for step in source)
    on_ball = (1.0 / (1.0 + (ball / ankle) ** STRICTNESS))[:, None]
    lacking = [growth * a - b for a, b in zip(source, target, strict=True)]
    wanted = (lacking[0] + on_ball * (lacking[1] - lacking[0])) * frame_rate
    shift[:, :2] = smooth_correction(wanted, held.astype(np.float64), frame_rate, BLEND)
    return shift
