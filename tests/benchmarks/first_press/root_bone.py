"""Spin a body, and put it below a bone that stands still, as many rigs have above the hips."""

import numpy as np

from solvers.arrays import Array
from solvers.motion import Motion, Skeleton
from solvers.rotations import inverse, multiply, quaternion_from_rotation_vector, rotate
from solvers.signals import smoothstep

SPIN_S = 1.0
BONE = quaternion_from_rotation_vector([0.4, -0.2, 1.0])
"""Rotation of the bone: rigs have it tilted and turned."""
OFFSET_M = (0.1, 0.0, 0.9)
"""From the bone to the hips."""


def spin(motion: Motion, degrees: float) -> Motion:
    """Turn the body about the vertical through its mean position, in the middle of the take."""
    seconds = (np.arange(motion.n_frames) - (motion.n_frames - 1) / 2) / motion.frame_rate
    angles = np.radians(degrees) * smoothstep(seconds, -SPIN_S / 2, SPIN_S / 2)
    rotation = quaternion_from_rotation_vector(angles[:, None] * (0.0, 0.0, 1.0))
    center = motion.root_positions.mean(axis=0) * (1.0, 1.0, 0.0)
    rotations = motion.rotations.copy()
    rotations[:, 0] = multiply(rotation, rotations[:, 0])
    return motion.with_poses(
        rotations, center + rotate(rotation, motion.root_positions - center)
    )


def below_bone(motion: Motion) -> Motion:
    """Return the same motion of a rig with a still bone above the hips."""
    skeleton = motion.skeleton
    parents = (-1, *(parent + 1 for parent in skeleton.parents))
    offsets = np.vstack([np.zeros(3), OFFSET_M, skeleton.offsets[1:]])
    rig = Skeleton(("still bone", *skeleton.names), parents, offsets)
    rotations = np.insert(motion.rotations, 0, BONE, axis=1)
    rotations[:, 1] = multiply(inverse(BONE), motion.rotations[:, 0])
    return Motion(rig, rotations, motion.root_positions - _offset(BONE), motion.frame_rate)


def without_bone(motion: Motion, like: Motion) -> Motion:
    """Return the body alone; inverts `below_bone`."""
    rotations = motion.rotations[:, 1:].copy()
    rotations[:, 0] = multiply(motion.rotations[:, 0], rotations[:, 0])
    roots = motion.root_positions + _offset(motion.rotations[:, 0])
    return like.with_poses(rotations, roots)


def _offset(bone: Array) -> Array:
    return rotate(bone, OFFSET_M)
