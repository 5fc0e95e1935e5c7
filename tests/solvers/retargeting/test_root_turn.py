"""A root bone follows the heading of a walk, and does not rotate in flips or on the ground."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rigs import mixamo

from solvers.motion import Motion, find_humanoid_map
from solvers.recordings import read_recording
from solvers.retargeting import ground_path
from solvers.rotations.representations import (
    angle_between,
    multiply,
    quaternion_from_rotation_vector,
)

FULL_CIRCLE = np.linspace(0.0, 2.0 * np.pi, 120)


@pytest.mark.parametrize("axis", [(1.0, 0, 0), (-1.0, 0, 0), (0, 1.0, 0)])
@pytest.mark.parametrize("smoothing", [0.0, 0.5])
def test_root_does_not_rotate_in_flips_and_cartwheels(axis, smoothing):
    flip = rotating_body(quaternion_from_rotation_vector(FULL_CIRCLE[:, None] * np.array(axis)))

    path = ground_path(flip, find_humanoid_map(flip.skeleton), smoothing)

    assert_allclose(np.abs(path.rotations[:, 0]), 1.0, atol=1e-9)


@pytest.mark.parametrize("bow", [0.5, 1.0, 1.7])
def test_heading_of_a_bowing_actor_is_followed(bow):
    """Rotated by 250 degrees with a bow; the heading is defined in every frame."""
    yaw = quaternion_from_rotation_vector(0.7 * FULL_CIRCLE[:, None] * np.array([0, 0, 1.0]))
    tilt = bow * np.sin(0.5 * FULL_CIRCLE)[:, None] * np.array([1.0, 0, 0])
    motion = rotating_body(multiply(yaw, quaternion_from_rotation_vector(tilt)))

    path = ground_path(motion, find_humanoid_map(motion.skeleton), 0.0)

    assert angle_between(path.rotations, yaw).max() < 1e-6


def test_root_rotates_smoothly_while_an_actor_gets_up():
    """Lies down facing -Y and gets up with another heading, 90 degrees away."""
    tilt = np.radians(90.0) * np.sin(0.5 * FULL_CIRCLE)[:, None] * np.array([1.0, 0, 0])
    angle = 0.5 * np.pi * np.round(0.5 * FULL_CIRCLE / np.pi)[:, None] * np.array([0, 0, 1.0])
    motion = rotating_body(
        multiply(quaternion_from_rotation_vector(angle), quaternion_from_rotation_vector(tilt))
    )

    path = ground_path(motion, find_humanoid_map(motion.skeleton), 0.0)

    assert angle_between(path.rotations[-1], path.rotations[0]) == pytest.approx(0.5 * np.pi)
    assert angle_between(path.rotations[1:], path.rotations[:-1]).max() < np.radians(3.0)


def test_root_does_not_spin_when_an_actor_lies_down(recordings):
    """The horizontal direction reverses there: 3000 degrees per second."""
    motion = read_recording(recordings / "mocap/hdm05/HDM_bd_lieDownFloor_002_120.amc")

    path = ground_path(motion, find_humanoid_map(motion.skeleton))

    speed = angle_between(path.rotations[1:], path.rotations[:-1]) * motion.frame_rate
    assert np.degrees(speed.max()) < 100.0


def rotating_body(hips: np.ndarray) -> Motion:
    rig = mixamo()
    rotations = np.tile([1.0, 0, 0, 0], (len(hips), rig.n_joints, 1))
    rotations[:, 0] = hips
    return Motion(rig, rotations, np.tile(rig.rest_positions[0], (len(hips), 1)), 60.0)
