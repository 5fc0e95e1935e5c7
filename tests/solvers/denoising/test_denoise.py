"""A cleaned recording must be complete, close to the truth, and say what was done."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising import (
    DenoiseSettings,
    Method,
    denoise,
    learn_filter_bases,
    load_filter_bases,
)
from solvers.motion import Motion, Tracks
from solvers.motion.rotations import angle_between, multiply, quaternion_from_rotation_vector


@pytest.mark.parametrize("method", Method)
@pytest.mark.parametrize("with_examples", [True, False])
def test_removes_most_of_the_noise(swinging_leg, rng, method, with_examples):
    bases = learn_filter_bases([swinging_leg]) if with_examples else None
    noisy = shaken(swinging_leg, rng, np.radians(3))

    result = denoise(noisy, bases, settings=DenoiseSettings(method=method))

    before = angle_between(noisy.rotations, swinging_leg.rotations)[:, :3].mean()
    after = angle_between(result.recording.rotations, swinging_leg.rotations)[:, :3].mean()
    # Without examples the published cut keeps what is 99 % of a noisy take: mostly its noise.
    assert after < (0.95 if method is Method.PUBLISHED and not with_examples else 0.6) * before


def test_fills_every_gap(swinging_leg, rng):
    noisy = shaken(swinging_leg, rng, np.radians(1))
    noisy.rotations[30:50, 1] = np.nan
    noisy.root_positions[70:80] = np.nan

    result = denoise(noisy)

    assert result.recording.observed.all()
    assert result.confidence[40, 1] < result.confidence[10, 1]


def test_bases_survive_the_file(swinging_leg, tmp_path):
    bases = learn_filter_bases([swinging_leg])

    bases.save(tmp_path / "walk.bases.npz")

    assert_allclose(load_filter_bases(tmp_path / "walk.bases.npz").vectors, bases.vectors)


@pytest.mark.parametrize("n_frames", [1, 2, 3, 7, 30])
def test_the_shortest_takes_are_returned_whole(swinging_leg, n_frames):
    short = swinging_leg.slice(0, n_frames)

    assert denoise(short).recording.observed.all()


def test_cleans_points_too(swinging_leg, rng):
    time = np.arange(90) / 30.0
    truth = np.stack([0.1 * np.sin(6 * time), -time, 1 + 0.05 * np.cos(6 * time)], axis=-1)
    truth = truth[:, None] + np.array([[0.0, 0, 0], [0.2, 0, 0.1], [0, 0.1, 0.3]])
    noisy = Tracks(("a", "b", "c"), truth + rng.normal(scale=0.01, size=truth.shape), 30.0)
    noisy.positions[20:30, 1] = np.nan

    cleaned = denoise(noisy).recording.positions

    seen = noisy.visible
    assert (
        np.abs(cleaned - truth)[seen].mean()
        < 0.7 * np.abs(noisy.positions - truth)[seen].mean()
    )
    assert np.isfinite(cleaned).all()


def shaken(motion: Motion, rng: np.random.Generator, scale: float) -> Motion:
    """The motion with rotation noise of this standard deviation, radians."""
    vectors = rng.normal(scale=scale, size=(motion.n_frames, motion.n_joints, 3))
    vectors[:, 3:] = 0.0
    noise = quaternion_from_rotation_vector(vectors)
    return motion.with_poses(multiply(motion.rotations, noise))
