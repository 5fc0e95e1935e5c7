"""A spline takes over where it predicts better: clean takes stay clean, kicks stay whole."""

from dataclasses import replace

import numpy as np
from numpy.testing import assert_allclose

from solvers.denoising import denoise
from solvers.denoising.averaging import (
    average_estimates,
    noise_factors,
    smooth_by_spline,
    smoothing_spline,
)
from solvers.denoising.channels import Estimate, Smoothed
from solvers.denoising.motion_model import estimate_joint_noise
from solvers.motion import Motion, find_humanoid_map
from solvers.rotations import angle_between, multiply, quaternion_from_rotation_vector
from solvers.samples import walker_skeleton

KICK_FRAME = 45


def test_leave_one_out_error_is_that_of_a_fit_without_the_sample(rng, monkeypatch):
    smoothness, n_frames, left_out = 3.0, 30, 11
    monkeypatch.setattr(smoothing_spline, "SMOOTHNESS", np.array([smoothness]))
    samples = np.cumsum(rng.normal(size=(n_frames, 2)), axis=0)

    error = smooth_by_spline(samples).leave_one_out_error[left_out]

    second_differences = np.diff(np.eye(n_frames), 2, axis=0)
    weights = np.diag((np.arange(n_frames) != left_out).astype(float))
    system = weights + smoothness * second_differences.T @ second_differences
    without_sample = np.linalg.solve(system, weights @ samples)
    assert_allclose(error, samples[left_out] - without_sample[left_out], atol=1e-9)


def test_spline_leaves_a_straight_line_as_it_is():
    line = np.linspace(-3.0, 40.0, 200)[:, None]

    assert_allclose(smooth_by_spline(line).values, line, atol=1e-9)


def test_spline_is_nearer_to_a_wave_than_the_samples(rng):
    wave = 20.0 * np.sin(np.arange(1300) / 15.0)[:, None]
    samples = wave + rng.normal(size=wave.shape)

    smooth = smooth_by_spline(samples).values

    assert np.sqrt(np.mean((smooth - wave) ** 2)) < 0.6


def test_weights_are_those_of_the_least_error(rng):
    """Of two smoothers of independent errors, the mean is weighted by the inverse variances."""
    truth = np.zeros((4000, 3))
    noisy = truth + rng.normal(size=truth.shape)
    variances = 1.0 / np.array([4.0, 8.0])  # of the mean of so many samples that contain it
    smoothed = [_mean_of_samples(noisy, round(1.0 / each), rng) for each in variances]
    useless = _estimate(noisy)

    _, weights = average_estimates(
        noisy,
        useless,
        smoothed,
        np.ones(noisy.shape, dtype=bool),
        np.ones(3),
    )

    correlation = variances[0] * variances[1]  # both contain the sample itself
    gaps = variances - correlation
    expected = gaps[::-1] / gaps.sum()
    assert_allclose(weights[0], [0.0, *expected], atol=0.05)


def test_clean_take_keeps_its_samples(rng):
    """Without noise, the candidate that changes nothing wins, although it predicts badly."""
    clean = 20.0 * np.sin(np.outer(np.arange(200) / 20.0, np.arange(1.0, 7.0)))
    unchanged = Smoothed(clean, 5.0 + rng.normal(size=clean.shape), np.ones_like(clean))
    blurred = replace(_estimate(clean + 0.5), leave_one_out_error=np.full(clean.shape, -0.5))

    stacked, weights = average_estimates(
        clean, blurred, [unchanged], np.ones(clean.shape, dtype=bool), np.full(6, 0.01)
    )

    assert_allclose(weights, np.tile([0.0, 1.0], (2, 1)), atol=0.02)
    assert_allclose(stacked.values, clean, atol=0.01)


def test_noise_factors_distinguish_movement_from_noise(rng):
    """A spline follows fast movement, whose third differences are as large as noise's."""
    frames = np.arange(200)
    fast = 30.0 * np.sin(np.outer(frames / 2.0, np.linspace(0.8, 1.2, 30)))
    noisy = fast + 3.0 * rng.normal(size=fast.shape)

    one_noisy_joint = np.hstack([fast[:, :27], (noisy - fast)[:, 27:]])

    clean, both, noise, one = (
        _noise_factors(samples) for samples in (fast, noisy, noisy - fast, one_noisy_joint)
    )

    assert clean.max() < 0.1
    assert 0.25 < both.min() <= both.max() < 1.0
    assert noise.min() > 0.8
    assert one[:27].max() < 0.1 and one[27:].min() > 0.8


def test_clean_kick_keeps_its_height(rng):
    kick = _kick(rng)

    cleaned = denoise(kick)

    assert isinstance(cleaned.recording, Motion)
    errors = np.degrees(angle_between(cleaned.recording.rotations, kick.rotations))
    assert errors.max() < 2.0
    assert not cleaned.outliers.any()


def test_spike_before_a_kick_is_removed(rng):
    kick = _kick(rng)
    leg = kick.skeleton.index(find_humanoid_map(kick.skeleton).joints["leftUpperLeg"])
    rotations = kick.rotations.copy()
    off = quaternion_from_rotation_vector([0.0, np.radians(50.0), 0.0])
    rotations[20, leg] = multiply(rotations[20, leg], off)

    cleaned = denoise(kick.with_poses(rotations))

    assert isinstance(cleaned.recording, Motion)
    assert np.flatnonzero(cleaned.outliers[:, leg]).tolist() == [20]
    error = angle_between(cleaned.recording.rotations[20, leg], kick.rotations[20, leg])
    assert np.degrees(error) < 3.0


def _noise_factors(samples: np.ndarray) -> np.ndarray:
    noise = estimate_joint_noise(samples, 0.01).deviation
    good = np.ones(samples.shape, dtype=bool)
    return noise_factors(noise, samples, [smooth_by_spline(samples)], good)


def _mean_of_samples(noisy: np.ndarray, n: int, rng: np.random.Generator) -> Smoothed:
    """Return each sample's mean with n - 1 others of the same noise."""
    others = rng.normal(size=noisy.shape) / np.sqrt(n - 1)
    return Smoothed(noisy / n + others * (n - 1) / n, noisy - others, np.ones_like(noisy) / n)


def _estimate(noisy: np.ndarray) -> Estimate:
    """Return the samples themselves as the estimate."""
    ones = np.ones_like(noisy)
    return Estimate(noisy, ones, ones, 0.0 * noisy, 1, True)


def _kick(rng: np.random.Generator) -> Motion:
    """A person who sways slowly and kicks once, at 18 degrees a frame, nearly without noise."""
    skeleton, frames = walker_skeleton(), np.arange(90)
    vectors = np.zeros((len(frames), skeleton.n_joints, 3))
    vectors[:] = np.radians(0.1) * rng.normal(size=vectors.shape)
    vectors[..., 0] += np.radians(4.0) * np.sin(frames / 12.0)[:, None]
    leg = skeleton.index(find_humanoid_map(skeleton).joints["leftUpperLeg"])
    vectors[:, leg, 0] -= np.radians(60.0) * np.exp(-0.5 * ((frames - KICK_FRAME) / 2.0) ** 2)
    roots = np.tile([0.0, 0.0, 1.0], (len(frames), 1))
    return Motion(skeleton, quaternion_from_rotation_vector(vectors), roots, 30.0)
