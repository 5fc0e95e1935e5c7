"""Joints that stop, at a limit or because angles are rounded, are not held by a tracker."""

import numpy as np

from solvers.denoising.held_samples import find_held_samples
from solvers.motion import Motion
from solvers.rotations import (
    quaternion_from_rotation_vector,
    rotation_vector_from_quaternion,
)

FIRST, LAST = 40, 55


def flex(motion: Motion, joints: list[int], degrees: np.ndarray) -> Motion:
    """Return the motion with joints that flex by these angles."""
    rotations = motion.rotations.copy()
    vectors = np.radians(degrees)[:, None, None] * [1.0, 0.0, 0.0]
    rotations[:, joints] = quaternion_from_rotation_vector(vectors)
    return motion.with_poses(rotations)


def test_body_in_rounded_angles_is_not_held(walk):
    """Joints that turn around repeat by chance, some of them in the same frame."""
    step = np.radians(0.5)
    rounded = step * np.round(rotation_vector_from_quaternion(walk.rotations) / step)
    motion = walk.with_poses(quaternion_from_rotation_vector(rounded))
    assert not find_held_samples(motion).any()


def test_knee_that_is_straight_once_is_not_held(walk):
    """A solver that stops knees where they are straight leaves the stop with a jump."""
    angles = [*range(45, 3, -3), 1, *[0] * 20, *np.linspace(7.4, 100.0, walk.n_frames - 35)]
    knee = walk.skeleton.index("RightLeg")
    assert not find_held_samples(flex(walk, [knee], np.asarray(angles))).any()


def test_two_joints_that_are_not_connected_are_not_lost_together(walk):
    """Toes of an animated rig stop together where the feet are flat."""
    degrees = 20.0 * np.abs(np.sin(np.arange(walk.n_frames) / 4.0))
    degrees[FIRST : LAST + 1] = degrees[70:74] = 3.0
    toes = [walk.skeleton.index(name) for name in ("LeftToeBase", "RightToeBase")]
    assert not find_held_samples(flex(walk, toes, degrees)).any()
    leg = [walk.skeleton.index(name) for name in ("LeftFoot", "LeftToeBase")]
    held = find_held_samples(flex(walk, leg, degrees))
    assert held[FIRST + 1 : LAST + 1, leg].all()
