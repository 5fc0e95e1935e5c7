"""The noise of a joint: one figure for all axes it turns about, found while the joint moves."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from solvers.denoising import denoise
from solvers.denoising.motion_model import JointNoise, estimate_joint_noise
from solvers.motion import Motion, Skeleton
from solvers.rotations import angle_between, quaternion_from_rotation_vector

N_FRAMES, N_JOINTS, MINIMUM = 400, 12, 1e-3
TURN = Rotation.from_rotvec([0.5, -0.8, 0.3]).as_matrix()


@pytest.fixture
def movement():
    """Slow swings of joints with three channels, shape (N_FRAMES, N_JOINTS, 3)."""
    time = np.arange(N_FRAMES)[:, None, None] / 30.0
    rates = np.linspace(0.2, 0.8, 3 * N_JOINTS).reshape(N_JOINTS, 3)
    return 20.0 * np.sin(2.0 * np.pi * rates * time)


def estimated(joints: np.ndarray) -> JointNoise:
    return estimate_joint_noise(joints.reshape(len(joints), -1), MINIMUM)


def test_noise_of_all_axes_is_one_figure(movement, rng):
    noise = estimated(movement + rng.normal(scale=2.0, size=movement.shape))

    assert_allclose(noise.covariances, 4.0 * np.tile(np.eye(3), (N_JOINTS, 1, 1)), atol=0.6)
    assert np.ptp(noise.deviation[:3]) < 1e-9


def test_joint_of_one_axis_has_the_noise_of_this_axis(movement, rng):
    """A knee that only bends, about an axis that is none of its channels."""
    knee, axis = 3, TURN[:, 0]
    noisy = movement + rng.normal(scale=2.0, size=movement.shape)
    noisy[:, knee] = (noisy[:, knee] @ axis)[:, None] * axis

    noise = estimated(noisy)

    assert_allclose(np.sqrt(noise.covariances[knee].diagonal()), 2.0, rtol=0.15)
    expected = 2.0 * np.abs(axis)
    assert_allclose(noise.deviation.reshape(N_JOINTS, 3)[knee], expected, rtol=0.15)


def test_joint_keeps_its_much_larger_noise_about_one_axis(movement, rng):
    forearm, axis = 5, TURN[:, 1]
    noisy = movement + rng.normal(scale=0.5, size=movement.shape)
    noisy[:, forearm] += rng.normal(scale=8.0, size=(N_FRAMES, 1)) * axis

    noise = estimated(noisy).covariances

    assert_allclose(np.sqrt(axis @ noise[forearm] @ axis), 8.0, rtol=0.2)
    assert np.sqrt(TURN[:, 0] @ noise[forearm] @ TURN[:, 0]) < 2.0


def test_position_has_the_larger_noise_of_a_depth_camera_along_its_axis(movement, rng):
    """A rotation with the same noise has one figure for all axes."""
    depth = TURN[:, 2]
    noisy = movement + rng.normal(scale=0.5, size=movement.shape)
    noisy[:, [0, -1]] += rng.normal(scale=1.5, size=(N_FRAMES, 2, 1)) * depth
    samples = noisy.reshape(N_FRAMES, -1)

    noise = estimate_joint_noise(samples, MINIMUM, samples.shape[1] - 3).covariances

    assert_allclose(np.sqrt(depth @ noise[-1] @ depth), np.hypot(0.5, 1.5), rtol=0.2)
    assert_allclose(np.sqrt(TURN[:, 0] @ noise[-1] @ TURN[:, 0]), 0.5, rtol=0.3)
    assert_allclose(noise[0], noise[0, 0, 0] * np.eye(3), atol=1e-9)


def test_noisier_joint_keeps_its_own_noise(movement, rng):
    hand = 7
    scale = np.full((N_JOINTS, 1), 0.5)
    scale[hand] = 3.0

    deviation = estimated(movement + scale * rng.normal(size=movement.shape)).deviation

    assert_allclose(deviation.reshape(N_JOINTS, 3)[hand], 3.0, rtol=0.15)
    assert_allclose(np.delete(deviation.reshape(N_JOINTS, 3), hand, axis=0), 0.5, rtol=0.1)


def test_axes_of_a_rigs_joints_turn_the_noise(movement, rng):
    noisy = movement + rng.normal(size=movement.shape)
    noisy[:, 2] += rng.normal(scale=6.0, size=(N_FRAMES, 1)) * TURN[:, 1]

    noise, turned = estimated(noisy).covariances, estimated(noisy @ TURN).covariances

    assert_allclose(turned, TURN.T @ noise @ TURN, atol=1e-9)


def test_still_joint_gets_the_noise_of_the_others(movement, rng):
    noisy = movement + rng.normal(scale=2.0, size=movement.shape)
    noisy[:, 4] = 10.0

    assert_allclose(estimated(noisy).deviation[12:15], 2.0, rtol=0.1)


@pytest.mark.parametrize("n_frames", [1, 3, 4, 12])
def test_short_and_empty_takes_have_the_least_noise_or_more(n_frames, rng):
    noisy = rng.normal(size=(n_frames, 2, 3))
    noisy[:, 1] = np.nan

    noise = estimated(noisy)

    assert np.isfinite(noise.deviation).all()
    assert (np.linalg.eigvalsh(noise.covariances) > 0.9 * MINIMUM**2).all()


def test_take_that_stands_still_has_the_least_noise():
    assert_allclose(estimated(np.ones((60, 2, 3))).deviation, MINIMUM)


def test_clean_smooths_a_joint_whose_other_channels_stand_still(rng):
    skeleton = Skeleton(("base", "tip"), (-1, 0), np.array([[0, 0, 0], [0, 0, 0.5]]))
    bend = np.zeros((60, 2, 3))
    bend[:, 0, 0] = 0.5 * np.sin(np.arange(60) / 8.0)
    truth = quaternion_from_rotation_vector(bend)
    bend[:, 0, 0] += rng.normal(scale=0.05, size=60)
    noisy = Motion(skeleton, quaternion_from_rotation_vector(bend), np.zeros((60, 3)), 30.0)

    cleaned = denoise(noisy).recording

    assert isinstance(cleaned, Motion)
    before, after = (
        angle_between(each.rotations[:, 0], truth[:, 0]).mean() for each in (noisy, cleaned)
    )
    assert after < 0.6 * before
