"""When the feet of a simulated body stand, and on which part of their soles."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ..motion import HumanoidMap, Motion, detect_contacts
from .body import PhysicsBody
from .surface import SIDES, bottoms, of_foot, sole_speeds

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
CALM = 0.02
"""Seconds of the Gaussian through which loads, heights and speeds are looked at."""

LEAST, FULL = 0.05, 0.15
"""Shares of the weight: who carries the former begins to stand, with the latter stands."""

SLIDING, SLIPPING = 0.3, 0.5
"""Metres per second, for legs of 0.9 m: a sole that carries weight is held if it is slower than
the former, and let slip if it is faster than the latter."""

LOW, HIGH = 0.02, 0.03
"""Metres over the ground, for legs of 0.9 m: a foot that stands in the target is held where the
simulated one is lower than the former, and not above the latter."""

ROLLING = 0.002
"""Metres, for legs of 0.9 m: a part of the sole this much higher bears 1/e of the load."""


def in_contact(body: PhysicsBody, motion: Motion) -> Flags:
    """Tell when the feet of a motion stand, shape (n_frames, 2); a body without never does."""
    humanoid = HumanoidMap({
        role: body.skeleton.names[joint] for joint, role in body.roles.items()
    })
    if not humanoid.has(*(f"{side}Foot" for side in SIDES)):
        return np.zeros((motion.n_frames, len(SIDES)), dtype=np.bool_)
    return detect_contacts(motion, humanoid)


def standing(
    body: PhysicsBody,
    motion: Motion,
    loads: Array,
    in_target: Array,
    ground: float,
) -> Array:
    """Return how firmly each simulated foot should be held where it is, 0 to 1.

    It stands where it carries weight and hardly moves: that is what the simulation itself says,
    and needs no guess of heights. It also stands where it does in the target, though the other
    foot may bear all the weight here, if it is near the ground.

    Parameters
    ----------
    body : PhysicsBody
    motion : Motion
        As it was simulated.
    loads : shape (n_frames, n_ends)
        By which the ground carries each end of `PhysicsBody.grounded`, as a share of the
        weight.
    in_target : shape (n_frames, 2), 0 to 1
        How firmly the feet of what is followed stand.
    ground : float, metres

    Returns
    -------
    Array
        Shape (n_frames, 2), left and right.
    """
    points = bottoms(body, motion)
    speeds = _calmed(sole_speeds(body, motion), motion.frame_rate) / body.size
    slow = np.clip((SLIPPING - speeds) / (SLIPPING - SLIDING), 0.0, 1.0)
    firm = np.zeros((motion.n_frames, 2))
    for column, side in enumerate(SIDES):
        own = of_foot(body, side)
        if own.any():
            load = _calmed(loads[:, own].sum(axis=1), motion.frame_rate)
            carries = np.clip((load - LEAST) / (FULL - LEAST), 0.0, 1.0)
            height = (points[:, own, 2].min(axis=1) - ground) / body.size
            near = np.clip((HIGH - height) / (HIGH - LOW), 0.0, 1.0)
            firm[:, column] = np.maximum(carries * slow[:, column], in_target[:, column] * near)
    return firm


def from_frame_to_frame(firm: Array) -> Array:
    """Return how firmly feet are held between frames, shape (n_frames - 1, 2)."""
    return np.minimum(firm[1:], firm[:-1])


def bearing(heights: Array, frame_rate: float, size: float) -> Array:
    """Return which part of the load each point of a sole bears, adding up to 1.

    The lowest do; as a foot rolls, it passes from the heel to the ball and on to the toes.

    Parameters
    ----------
    heights : shape (n_frames, n_points), metres
        Over the ground; what is under it presses no more than what is on it.
    frame_rate : float, hertz
    size : float
        Of the body: its legs over 0.9 m.
    """
    over = _calmed(np.maximum(heights, 0.0), frame_rate)
    shares = np.exp((over.min(axis=1, keepdims=True) - over) / (ROLLING * size))
    return np.asarray(shares / shares.sum(axis=1, keepdims=True))


def carried(body: PhysicsBody, loads: Array) -> Array:
    """Return the share of the weight that each foot carries, shape (n_frames, 2)."""
    return np.stack([loads[:, of_foot(body, side)].sum(axis=1) for side in SIDES], axis=-1)


def _calmed(values: Array, frame_rate: float) -> Array:
    return np.asarray(gaussian_filter1d(values, CALM * frame_rate, axis=0, mode="nearest"))
