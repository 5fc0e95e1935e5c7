"""How the skin of a body lies to the ground."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d, grey_opening, median_filter

from ..motion import Motion, forward_kinematics
from ..rotations import rotate
from .body import PhysicsBody

Array = NDArray[np.float64]
SIDES = ("left", "right")
LEG = ("UpperLeg", "LowerLeg", "Foot")
NEAR = 0.005
"""Metres, for legs of 0.9 m: a sole as near to the ground touches it."""

SLOW = 1.0
"""Seconds: what a body does for longer, over or under the ground, is taken for an error."""

SHALLOW = 0.02
"""Metres, for legs of 0.9 m, by which a body may be under the ground for long: one foot often
is a little lower than the other, and legs that press it down stand more firmly."""

HIGHEST = 0.25
"""Metres, for legs of 0.9 m, of hovering that is taken for an error."""


def end_joints(body: PhysicsBody) -> NDArray[np.intp]:
    """Return the joint that each end of `PhysicsBody.grounded` is fixed to, (n_ends,)."""
    return np.repeat(np.array([each.joint for each in body.grounded], dtype=np.intp), 2)


def bottoms(body: PhysicsBody, motion: Motion) -> Array:
    """Return the lowest points of the ends of `PhysicsBody.grounded`.

    Shape (n_frames, n_ends, 3), metres.
    """
    poses, joints = forward_kinematics(motion), end_joints(body)
    ends = np.concatenate([each.ends for each in body.grounded])
    points = poses.positions[:, joints] + rotate(poses.rotations[:, joints], ends)
    points[..., 2] -= np.repeat([each.radius for each in body.grounded], 2)
    return np.asarray(points)


def measure_clearance(body: PhysicsBody, motion: Motion, ground: float) -> Array:
    """Return how high the lowest point of the body is over the ground, (n_frames,), metres."""
    return np.asarray(bottoms(body, motion)[..., 2].min(axis=1) - ground)


def penetration(body: PhysicsBody, motion: Motion, ground: float) -> float:
    """Return how deep the body is under the ground where it is deepest, metres; 0 above."""
    return float(max(0.0, -measure_clearance(body, motion, ground).min()))


def raising(heights: Array, frame_rate: float, size: float) -> Array:
    """Return by how much to raise a target that is under the ground, or hovers, for long.

    What is under it for a moment is for the legs to mend, and who leaves it for a moment jumps.
    A body that hovers higher than anyone's shoes are thick is not on this ground at all.

    Parameters
    ----------
    heights : shape (n_frames,), metres
        Of the body's lowest point over the ground.
    frame_rate : float, hertz
    size : float
        Of the body: its legs over 0.9 m.

    Returns
    -------
    Array
        Shape (n_frames,), metres; negative where the target is to be lowered.
    """
    window = min(2 * int(SLOW * frame_rate / 2) + 1, 2 * len(heights) - 1)
    sunk = np.maximum(-heights - SHALLOW * size, 0.0)
    under = median_filter(sunk, size=window, mode="nearest")
    over = grey_opening(np.maximum(heights, 0.0), size=window, mode="nearest")
    over = np.where(over > HIGHEST * size, 0.0, over)
    return np.asarray(gaussian_filter1d(under - over, SLOW / 4 * frame_rate, mode="nearest"))


def touching(body: PhysicsBody, motion: Motion, ground: float) -> NDArray[np.bool_]:
    """Return whether the left and the right foot touch the ground, shape (n_frames, 2)."""
    near = bottoms(body, motion)[..., 2] < ground + NEAR * body.size
    return np.stack([near[:, of_foot(body, side)].any(axis=1) for side in SIDES], axis=-1)


def sole_speeds(body: PhysicsBody, motion: Motion) -> Array:
    """Return how fast each foot moves over the ground, shape (n_frames, 2), m/s.

    Of a foot that rolls, only what all its points share counts: the speed of the slowest.
    """
    points = bottoms(body, motion)
    speeds = np.zeros((motion.n_frames, 2))
    for column, side in enumerate(SIDES):
        own = of_foot(body, side)
        if own.any() and motion.n_frames > 1:
            steps = np.linalg.norm(np.diff(points[:, own, :2], axis=0), axis=-1)
            speeds[1:, column] = steps.min(axis=1) * motion.frame_rate
            speeds[0, column] = speeds[1, column]
    return speeds


def of_foot(body: PhysicsBody, side: str) -> NDArray[np.bool_]:
    """Tell which ends of `PhysicsBody.grounded` are of the left or right foot, (n_ends,)."""
    roles = {f"{side}Foot", f"{side}Toes"}
    joints = end_joints(body)
    return np.array([body.roles.get(int(joint)) in roles for joint in joints], dtype=np.bool_)


def leg_chain(body: PhysicsBody, side: str) -> tuple[int, int, int] | None:
    """Return hip, knee and ankle of a leg; None where they do not follow one another."""
    joints = {role: joint for joint, role in body.roles.items()}
    found = [joints.get(side + part) for part in LEG]
    if None in found:
        return None
    hip, knee, ankle = (joint for joint in found if joint is not None)
    skeleton = body.skeleton
    follows = hip in skeleton.ancestors(knee) and knee in skeleton.ancestors(ankle)
    return (hip, knee, ankle) if follows else None


def measure_foot_slide(body: PhysicsBody, motion: Motion, contacts: NDArray[np.bool_]) -> float:
    """Return the way in metres that both feet cover over the ground while they touch it."""
    standing = contacts[1:] & contacts[:-1]
    return float(sole_speeds(body, motion)[1:][standing].sum() / motion.frame_rate)
