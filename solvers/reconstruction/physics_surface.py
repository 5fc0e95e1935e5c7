"""How the skin of a body lies to the ground."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d, median_filter

from ..motion import Motion, forward_kinematics
from ..motion.rotations import rotate
from .physics_body import PhysicsBody

Array = NDArray[np.float64]
SLOW = 1.0
"""Seconds over which a body that is under the ground is raised with its target."""


def bottoms(body: PhysicsBody, motion: Motion) -> tuple[Array, NDArray[np.intp]]:
    """Return the lowest points of all capsules that touch the ground.

    Returns
    -------
    points : shape (n_frames, n_capsules, 3), metres
    joints : int, shape (n_capsules,)
    """
    poses = forward_kinematics(motion)
    touching = [capsule for capsule in body.capsules if capsule.touches]
    joints = np.array([capsule.joint for capsule in touching], dtype=np.intp)
    ends = np.stack([capsule.ends for capsule in touching], axis=1)
    radii = np.array([capsule.radius for capsule in touching])
    one, other = (
        poses.positions[:, joints] + rotate(poses.rotations[:, joints], end) for end in ends
    )
    lower = np.where(one[..., 2:] < other[..., 2:], one, other)
    lower[..., 2] -= radii
    return lower, joints


def penetration(body: PhysicsBody, motion: Motion, ground: float) -> Array:
    """Return how deep the body is under the ground, shape (n_frames,), metres; 0 above."""
    points, _ = bottoms(body, motion)
    return np.asarray(np.maximum(0.0, ground - points[..., 2].min(axis=1)))


def raising(depths: Array, frame_rate: float) -> Array:
    """Return how far a target must be raised that is under the ground for long, (n_frames,).

    What is under it for a moment is for the legs to mend.
    """
    window = 2 * int(SLOW * frame_rate / 2) + 1
    usual = median_filter(depths, size=min(window, 2 * len(depths) - 1), mode="nearest")
    return np.asarray(gaussian_filter1d(usual, SLOW / 4 * frame_rate, mode="nearest"))


def sole_speeds(body: PhysicsBody, motion: Motion) -> Array:
    """Return how fast each foot moves over the ground, shape (n_frames, 2), m/s.

    Of a foot that rolls, only what all its points share counts: the speed of the slowest.
    """
    points, joints = bottoms(body, motion)
    speeds = np.zeros((motion.n_frames, 2))
    for column, side in enumerate(("left", "right")):
        of_foot = [
            place
            for place, joint in enumerate(joints)
            if body.roles.get(int(joint)) in {f"{side}Foot", f"{side}Toes"}
        ]
        if of_foot and motion.n_frames > 1:
            steps = np.linalg.norm(np.diff(points[:, of_foot, :2], axis=0), axis=-1)
            speeds[1:, column] = steps.min(axis=1) * motion.frame_rate
            speeds[0, column] = speeds[1, column]
    return speeds


def slide(body: PhysicsBody, motion: Motion, contacts: NDArray[np.bool_]) -> float:
    """Return the way in metres that both feet cover over the ground while they touch it."""
    standing = contacts[1:] & contacts[:-1]
    return float(sole_speeds(body, motion)[1:][standing].sum() / motion.frame_rate)
