"""Put the feet of a target onto the ground where they stand, and over it where they swing."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ..motion import Motion, forward_kinematics, reach
from ..motion.humanoid import UP
from .body import PhysicsBody
from .surface import SIDES, bottoms, leg_chain, of_foot

Array = NDArray[np.float64]
CLEAR = 0.01
"""Metres over the ground, for legs of 0.9 m, at which a foot swings at least."""

PRESSED = 0.003
"""Metres under the ground, likewise, at which a foot stands, so that it carries its share."""

FARTHEST = 0.1
"""Metres over or under the ground, likewise: a standing foot farther off stands on something
else. One that swings is drawn up from any depth."""

CALM = 0.03
"""Seconds of the Gaussian that eases what feet are raised and lowered by."""


def with_feet_on_ground(
    body: PhysicsBody, motion: Motion, firm: Array, stands: Array, ground: float
) -> Motion:
    """Return the motion with legs drawn up or stretched so that the feet meet the ground.

    How thick soles are is not captured, and the floor of a take is level to a centimetre at
    best. A foot that swings into the ground would scuff it, and one that hovers where it should
    stand would leave all the weight to the other: the body tips.

    Parameters
    ----------
    body : PhysicsBody
    motion : Motion
    firm : shape (n_frames, 2), 0 to 1
        1 for a foot so slow that it may stand, 0 for one that swings.
    stands : shape (n_frames, 2), 0 to 1
        1 for a foot that does stand.
    ground : float, metres
    """
    points = bottoms(body, motion)
    positions, result = forward_kinematics(motion).positions, motion
    for column, side in enumerate(SIDES):
        own, chain = of_foot(body, side), leg_chain(body, side)
        if chain and own.any():
            heights = (points[:, own, 2].min(axis=1) - ground) / body.size
            rise = _rise(heights, firm[:, column], stands[:, column])
            rise = gaussian_filter1d(rise, CALM * motion.frame_rate, mode="nearest")
            goal = positions[:, chain[-1]] + body.size * rise[:, None] * UP
            result = reach(result, chain, goal)
    return result


def _rise(heights: Array, firm: Array, stands: Array) -> Array:
    """Return by how much to raise a foot, shape (n_frames,), for legs of 0.9 m."""
    near = np.clip(2.0 - 2.0 * np.abs(heights) / FARTHEST, 0.0, 1.0)
    lifted = (1.0 - firm) * np.maximum(CLEAR - heights, 0.0)
    return np.asarray(lifted - stands * near * (heights + PRESSED))
