"""A root bone turns with a body that walks, and not with one that flips or lies down."""

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

WHOLE_TURN = np.linspace(0.0, 2.0 * np.pi, 120)


@pytest.mark.parametrize("axis", [(1.0, 0, 0), (-1.0, 0, 0), (0, 1.0, 0)])
@pytest.mark.parametrize("smoothing", [0.0, 0.5])
def test_the_root_turns_in_no_flip_and_no_cartwheel(axis, smoothing):
    flip = turning(quaternion_from_rotation_vector(WHOLE_TURN[:, None] * np.array(axis)))

    path = ground_path(flip, find_humanoid_map(flip.skeleton), smoothing)

    assert_allclose(np.abs(path.rotations[:, 0]), 1.0, atol=1e-9)


@pytest.mark.parametrize("bow", [0.5, 1.0, 1.7])
def test_who_bows_while_turning_still_turns(bow):
    """Turned by 250 degrees, bowed in the middle: the twist is known in every frame."""
    yaw = quaternion_from_rotation_vector(0.7 * WHOLE_TURN[:, None] * np.array([0, 0, 1.0]))
    tilt = bow * np.sin(0.5 * WHOLE_TURN)[:, None] * np.array([1.0, 0, 0])
    motion = turning(multiply(yaw, quaternion_from_rotation_vector(tilt)))

    path = ground_path(motion, find_humanoid_map(motion.skeleton), 0.0)

    assert angle_between(path.rotations, yaw).max() < 1e-6


def test_who_gets_up_facing_elsewhere_has_turned_smoothly():
    """Lies down facing -Y and gets up a quarter turn farther on."""
    tilt = np.radians(90.0) * np.sin(0.5 * WHOLE_TURN)[:, None] * np.array([1.0, 0, 0])
    turn = 0.5 * np.pi * np.round(0.5 * WHOLE_TURN / np.pi)[:, None] * np.array([0, 0, 1.0])
    motion = turning(
        multiply(quaternion_from_rotation_vector(turn), quaternion_from_rotation_vector(tilt))
    )

    path = ground_path(motion, find_humanoid_map(motion.skeleton), 0.0)

    assert angle_between(path.rotations[-1], path.rotations[0]) == pytest.approx(0.5 * np.pi)
    assert angle_between(path.rotations[1:], path.rotations[:-1]).max() < np.radians(3.0)


def test_the_root_does_not_spin_when_a_person_lies_down(recordings):
    """Before, the direction over the ground reversed: 3000 degrees a second."""
    motion = read_recording(recordings / "mocap/hdm05/HDM_bd_lieDownFloor_002_120.amc")

    path = ground_path(motion, find_humanoid_map(motion.skeleton))

    speed = angle_between(path.rotations[1:], path.rotations[:-1]) * motion.frame_rate
    assert np.degrees(speed.max()) < 100.0


def turning(hips: np.ndarray) -> Motion:
    rig = mixamo()
    rotations = np.tile([1.0, 0, 0, 0], (len(hips), rig.n_joints, 1))
    rotations[:, 0] = hips
    return Motion(rig, rotations, np.tile(rig.rest_positions[0], (len(hips), 1)), 60.0)
