"""The mean pose of a take is its own where observed, else that of similar examples."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising.window_estimates.mean_pose import estimate_mean_pose

N_FRAMES = 100.0


@pytest.fixture
def means(rng):
    """Three actors with four clips each; missing and observed channels differ by actor."""
    people = rng.normal(size=(3, 12)) * 12.0
    return np.repeat(people, 4, axis=0) + rng.normal(size=(12, 12)) * 0.5


def mean_pose(means, own_mean, observed, noise=0.0):
    n_channels = means.shape[1]
    return estimate_mean_pose(
        means,
        own_mean,
        observed * N_FRAMES,
        N_FRAMES,
        np.full(n_channels, 16.0),
        np.full(n_channels, noise),
    )


def test_observed_channels_have_their_own_mean(means, rng):
    own_mean = means[0] + rng.normal(size=12) * 6.0

    mean, variance = mean_pose(means, own_mean, np.ones(12))

    assert_allclose(mean, own_mean, atol=0.01)
    assert (variance < 0.01).all()


def test_missing_limb_has_the_mean_pose_of_the_same_actor(means):
    observed = np.ones(12)
    observed[8:] = 0.0
    own_mean = np.where(observed > 0.0, means[5] + 0.3, 0.0)

    mean, variance = mean_pose(means, own_mean, observed)

    assert_allclose(mean[8:], means[4:8].mean(axis=0)[8:], atol=1.5)
    stranger, stranger_variance = mean_pose(means, own_mean + 60.0 * (observed > 0.0), observed)
    assert_allclose(stranger[8:], means.mean(axis=0)[8:], atol=1e-6)
    assert (stranger_variance[8:] > 5.0 * variance[8:]).all()


def test_mean_is_the_product_of_two_gaussians():
    """One example has no variance between clips; two are computed manually."""
    means = np.array([[-3.0, 1.0], [3.0, 1.0]])
    own_mean, observed = np.array([50.0, 1.0]), np.array([0.2, 0.2])

    mean, variance = mean_pose(means, own_mean, observed, noise=4.0)

    prior_variance = 2.0 * (8.0 / 2) ** 2 + 1e-6
    own_variance = 16.0 * 10.0 * (1 / 20.0 - 1 / 100.0) + 4.0 / 20.0 + 1e-6
    posterior_variance = 1.0 / (1.0 / prior_variance + 1.0 / own_variance)
    assert_allclose(
        mean[0], posterior_variance * (0.0 / prior_variance + 50.0 / own_variance), rtol=1e-9
    )
    assert_allclose(variance[0], posterior_variance, rtol=1e-9)


def test_take_never_observed_has_the_mean_of_the_examples(means):
    mean, variance = mean_pose(means, np.zeros(12), np.zeros(12))

    assert_allclose(mean, means.mean(axis=0), atol=1e-6)
    assert_allclose(variance, 2.0 * np.maximum(means.var(axis=0), (8.0 / 12) ** 2) + 1e-6)


def test_copies_of_examples_change_nothing(means):
    observed = np.ones(12)
    observed[8:] = 0.0
    own_mean = np.where(observed > 0.0, means[5] + 0.3, 0.0)

    mean, _ = mean_pose(np.repeat(means, 3, axis=0), own_mean, observed)

    assert_allclose(mean[8:], mean_pose(means, own_mean, observed)[0][8:], atol=1.0)


def test_many_different_clips_do_not_change_the_mean_pose(means, rng):
    observed = np.ones(12)
    observed[8:] = 0.0
    own_mean = np.where(observed > 0.0, means[5] + 0.3, 0.0)
    other_clips = means.mean(axis=0) + rng.normal(size=(5000, 12)) * 60.0 + 200.0

    mean, _ = mean_pose(np.concatenate([other_clips, means]), own_mean, observed)

    assert_allclose(mean[8:], means[4:8].mean(axis=0)[8:], atol=20.0)


def test_single_example_leaves_a_large_variance(means):
    own_mean = means[0] + 8.0

    mean, variance = mean_pose(means[:1], own_mean, np.full(12, 0.3))

    assert (np.abs(mean - own_mean) < 4.0).all()
    assert (variance > 1.0).all()
