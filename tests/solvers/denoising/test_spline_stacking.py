"""A spline takes over where it predicts better: clean takes stay clean, kicks stay whole."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising import denoise
from solvers.denoising.posterior import smoothing_spline
from solvers.denoising.posterior.estimate import Estimate
from solvers.denoising.posterior.smoothing_spline import smooth_by_spline
from solvers.denoising.posterior.spline_stacking import stack_with_spline
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


@pytest.mark.parametrize("weight", [0.0, 0.3, 1.0])
def test_weight_is_that_of_least_squares(rng, weight):
    """Against errors of which a mixture is exactly zero, that mixture is found."""
    samples = np.cumsum(rng.normal(size=(60, 3)), axis=0)
    spline = smooth_by_spline(samples)
    errors = -(1.0 - weight) / weight if weight else 50.0
    estimate = _estimate_with_error(samples, spline.leave_one_out_error * errors)

    stacked, n_smoothed = stack_with_spline(samples, estimate)

    expected = weight * estimate.values + (1.0 - weight) * spline.values
    assert_allclose(stacked.values, expected, atol=1e-6)
    assert n_smoothed == (weight < 0.5)


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


def _estimate_with_error(samples: np.ndarray, error: np.ndarray) -> Estimate:
    ones = np.ones_like(samples)
    estimate = Estimate(samples + 1.0, ones, ones, ones, 1, True)
    return replace(estimate, leave_one_out_error=error)


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
