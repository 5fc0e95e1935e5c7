"""Lift feet that swing over the ground, so that they do not scuff it."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ..motion import Motion, forward_kinematics, reach
from .physics_body import PhysicsBody
from .physics_surface import SIDES, bottoms, leg_chain, of_foot

Array = NDArray[np.float64]
CLEAR = 0.01
"""Metres over the ground, for legs of 0.9 m, at which a foot swings at least."""

CALM = 0.03
"""Seconds of the Gaussian that eases the lift."""


def with_clear_feet(body: PhysicsBody, motion: Motion, firm: Array, ground: float) -> Motion:
    """Return the motion with legs drawn up where a foot swings into the ground, or skims it.

    How thick soles are is not captured, and whoever swings a leg clears the ground by a
    centimetre or two. A foot that scuffs it would carry weight that it does not carry.

    Parameters
    ----------
    body : PhysicsBody
    motion : Motion
    firm : shape (n_frames, 2), 0 to 1
        How firmly each foot stands.
    ground : float, metres
    """
    points, joints = bottoms(body, motion)
    ankles = forward_kinematics(motion).positions
    result = motion
    for column, side in enumerate(SIDES):
        own, chain = of_foot(body, joints, side), leg_chain(body, side)
        if not own.any() or chain is None:
            continue
        lacking = CLEAR * body.size - (points[:, own, 2].min(axis=1) - ground)
        lift = (1.0 - firm[:, column]) * np.maximum(lacking, 0.0)
        if lift.any():
            lift = gaussian_filter1d(lift, CALM * motion.frame_rate, mode="nearest")
            up = ankles[:, chain[-1]] + lift[:, None] * (0.0, 0.0, 1.0)
            result = reach(result, chain, up)
    return result
