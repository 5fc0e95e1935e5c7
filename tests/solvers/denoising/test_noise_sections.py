"""A take whose noise changes is cleaned in sections; others are not."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.denoising import DenoiseSettings, denoise
from solvers.denoising.noise_sections import find_noise_changes
from solvers.motion import Motion, find_humanoid_map
from solvers.rotations import angle_between, multiply, quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait

HALF = 90
"""Frames of half a take, of 6 seconds."""


@pytest.fixture(scope="module")
def walk() -> Motion:
    return walking_gait(GaitSettings(duration=6.0, frame_rate=30.0))


def with_noise(motion: Motion, first: float, second: float) -> Motion:
    """Return the motion with noise of these degrees in its halves."""
    vectors = np.random.default_rng(3).normal(size=(*motion.rotations.shape[:2], 3))
    vectors *= np.where(np.arange(motion.n_frames) < HALF, first, second)[:, None, None]
    vectors[:, [motion.skeleton.is_end_site(joint) for joint in range(motion.n_joints)]] = 0.0
    noise = quaternion_from_rotation_vector(np.radians(vectors))
    return motion.with_poses(multiply(motion.rotations, noise))


def mean_error(motion: Motion, truth: Motion) -> float:
    """Return the mean angle to the truth, degrees."""
    return float(np.degrees(angle_between(motion.rotations, truth.rotations)).mean())


@pytest.mark.parametrize("noise", [(3.0, 0.3), (0.3, 3.0), (3.0, 0.0)])
def test_halves_are_cleaned_as_well_as_alone(walk, noise):
    noisy = with_noise(walk, *noise)

    cleaned = denoise(noisy)

    assert "2 sections were cleaned separately." in cleaned.prior_used
    assert isinstance(cleaned.recording, Motion)
    for start, stop in ((0, HALF), (HALF, walk.n_frames)):
        truth = walk.slice(start, stop)
        alone = denoise(noisy.slice(start, stop)).recording
        assert isinstance(alone, Motion)
        together = mean_error(cleaned.recording.slice(start, stop), truth)
        assert together < 1.25 * mean_error(alone, truth) + 0.1


@pytest.mark.parametrize("noise", [0.0, 0.3, 1.0, 3.0])
def test_take_of_equal_noise_is_one_section(walk, noise):
    assert find_noise_changes(with_noise(walk, noise, noise)) == ()


@pytest.mark.parametrize("frame_rate", [12.0, 24.0])
def test_slow_recording_is_one_section(frame_rate):
    """At these rates a kick cannot be distinguished from noise."""
    walk = walking_gait(GaitSettings(duration=180.0 / frame_rate, frame_rate=frame_rate))
    assert find_noise_changes(with_noise(walk, 3.0, 0.3)) == ()


def test_change_is_found_where_it_is(walk):
    (change,) = find_noise_changes(with_noise(walk, 3.0, 0.3))

    assert abs(change - HALF) <= 8


def test_sections_blend_without_a_jump(walk):
    cleaned = denoise(with_noise(walk, 3.0, 0.3)).recording

    assert isinstance(cleaned, Motion)
    steps = np.degrees(angle_between(cleaned.rotations[1:], cleaned.rotations[:-1]))
    true_steps = np.degrees(angle_between(walk.rotations[1:], walk.rotations[:-1]))
    near = slice(HALF - 15, HALF + 15)
    assert (steps - true_steps)[near].max() < 5.0  # of the recording: 13


def test_limb_that_is_missing_at_the_change_is_filled_in_one_section(walk):
    """A gap at the end of a section could be filled from one side alone."""
    noisy = with_noise(walk, 3.0, 0.3)
    arm = walk.skeleton.subtree(
        walk.skeleton.index(find_humanoid_map(walk.skeleton).joints["leftUpperArm"])
    )
    rotations = noisy.rotations.copy()
    rotations[HALF - 10 : HALF + 10, list(arm)] = np.nan

    assert find_noise_changes(noisy.with_poses(rotations)) == ()


def test_dropped_frames_are_no_quiet_section(walk):
    rotations = with_noise(walk, 3.0, 3.0).rotations.copy()
    rotations[60:100] = np.nan

    assert find_noise_changes(walk.with_poses(rotations)) == ()


def test_take_at_strength_zero_keeps_its_samples(walk):
    noisy = with_noise(walk, 3.0, 0.3)

    cleaned = denoise(noisy, settings=DenoiseSettings(strength=0.0)).recording

    assert isinstance(cleaned, Motion)
    assert_array_equal(cleaned.rotations, noisy.rotations)
    assert_allclose(cleaned.root_positions, noisy.root_positions, atol=1e-12)


@pytest.mark.parametrize("n_frames", [1, 2, 5, 16, 30])
def test_short_takes_are_one_section(walk, n_frames):
    assert find_noise_changes(with_noise(walk, 3.0, 3.0).slice(0, n_frames)) == ()
