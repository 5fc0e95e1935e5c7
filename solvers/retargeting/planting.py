"""Limit the sliding of feet to that of the source."""

import numpy as np

from ..arrays import Array, Flags
from ..signals import smooth_correction

Foot = tuple[Array, Array]
"""Ankle and ball, each of shape (n_frames, 3), meters."""

BLEND_S = 0.3
"""Seconds in which the correction of a planted foot fades. Chosen by hand: x0.5 costs 0.8 %, x2
costs 2.3 %."""
SELECTION_POWER = 8.0
"""Power of the speed ratio that selects ankle or ball as the standing point. Chosen by hand:
x0.5 gains 0.2 %, x2 costs nothing."""
MIN_STEP_M = 1e-9
"""Minimum length of a step in meters. It guards a division."""


def planting_shift(
    source_foot: Foot, target_foot: Foot, is_standing: Flags, scale: float, frame_rate: float
) -> Array:
    """Return the displacement of the ankle for which the foot slides like the source's, scaled.

    The slower of the source's ankle and ball stands. The same point of the target gets the
    same step in each frame, scaled; the result is the smoothest displacement with that.

    Parameters
    ----------
    source_foot, target_foot : Foot
        The target is that without the displacement.
    is_standing : bool, shape (n_frames,)
    scale : float
        Horizontal scale.
    frame_rate : float, hertz

    Returns
    -------
    NDArray, shape (n_frames, 3), meters
        Horizontal; fades before and after each contact.
    """
    shift = np.zeros_like(target_foot[0])
    in_contact = is_standing[1:] & is_standing[:-1]
    if not in_contact.any():
        return shift
    source, target = (
        [np.diff(point[:, :2], axis=0) for point in foot] for foot in (source_foot, target_foot)
    )
    ankle, ball = (np.linalg.norm(step, axis=1) + MIN_STEP_M for step in source)
    on_ball = (1.0 / (1.0 + (ball / ankle) ** SELECTION_POWER))[:, None]
    differences = [scale * a - b for a, b in zip(source, target, strict=True)]
    velocity = (differences[0] + on_ball * (differences[1] - differences[0])) * frame_rate
    shift[:, :2] = smooth_correction(
        velocity, in_contact.astype(np.float64), frame_rate, BLEND_S
    )
    return shift
