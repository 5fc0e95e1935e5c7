"""How plausible a motion's momentum is: the force that no ground could have given."""

import numpy as np
from scipy.ndimage import gaussian_filter1d

from solvers.arrays import Array
from solvers.motion import Motion, forward_kinematics
from solvers.physics.body import PhysicsBody
from solvers.physics.body_surface import measure_clearance
from solvers.rotations.representations import rotate

GRAVITY = np.array([0.0, 0.0, -9.81])
SMOOTHING_S = 0.05
"""Seconds of the Gaussian through which the center of mass is looked at."""
MAX_CONTACT_HEIGHT_M = 0.03
"""Meters over the ground up to which the lowest point may be pushed."""
FRICTION = 1.0


def center_of_mass(body: PhysicsBody, motion: Motion) -> Array:
    """Return where the mass is on average, shape (n_frames, 3), meters."""
    posed = forward_kinematics(motion)
    total = sum(
        capsule.mass
        * (
            posed.positions[:, capsule.joint]
            + rotate(posed.rotations[:, capsule.joint], capsule.ends.mean(axis=0))
        )
        for capsule in body.capsules
    )
    return np.asarray(total / sum(capsule.mass for capsule in body.capsules))


def impossible_force(body: PhysicsBody, motion: Motion, ground: float) -> float:
    """Return the mean force that the ground cannot give, as a fraction of the weight.

    The change of momentum, less gravity, must come from the ground: nothing while no part is
    near it, and else a push within the cone of friction. What is left over is impossible. A
    fifth of a second at either end is ignored, since the motion is unknown before
    and after.
    """
    center = gaussian_filter1d(
        center_of_mass(body, motion), SMOOTHING_S * motion.frame_rate, axis=0, mode="nearest"
    )
    acceleration = np.diff(center, 2, axis=0) * motion.frame_rate**2
    force = (acceleration - GRAVITY) / 9.81
    touches = measure_clearance(body, motion, ground)[1:-1] < MAX_CONTACT_HEIGHT_M
    left = np.where(touches, outside_cone(force), np.linalg.norm(force, axis=-1))
    border = min(round(4.0 * SMOOTHING_S * motion.frame_rate), len(left) // 3)
    return float(left[border : len(left) - border].mean())


def outside_cone(force: Array) -> Array:
    """Return how far forces (n, 3) are from those that push upwards within friction."""
    level, up = np.linalg.norm(force[:, :2], axis=-1), force[:, 2]
    across = (level - FRICTION * up) / np.hypot(1.0, FRICTION)
    along = (FRICTION * level + up) / np.hypot(1.0, FRICTION)
    return np.where(along > 0.0, np.maximum(across, 0.0), np.hypot(level, up))
