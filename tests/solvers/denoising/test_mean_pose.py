"""The mean pose of a take: its own where it was seen, else that of the examples like it."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising.posterior.mean_pose import take_offset

N_FRAMES = 100.0


@pytest.fixture
def means(rng):
    """Three people, four clips of each: they hold lost and seen channels each in their way."""
    people = rng.normal(size=(3, 12)) * 12.0
    return np.repeat(people, 4, axis=0) + rng.normal(size=(12, 12)) * 0.5


def offset(means, own, seen, noise=0.0):
    n_channels = means.shape[1]
    return take_offset(
        means,
        own,
        seen * N_FRAMES,
        N_FRAMES,
        np.full(n_channels, 16.0),
        np.full(n_channels, noise),
    )


def test_what_was_seen_throughout_has_its_own_mean(means, rng):
    own = means[0] + rng.normal(size=12) * 6.0

    mean, variance = offset(means, own, np.ones(12))

    assert_allclose(mean, own, atol=0.01)
    assert (variance < 0.01).all()


def test_a_lost_limb_is_held_as_the_same_person_holds_it(means):
    seen = np.ones(12)
    seen[8:] = 0.0
    own = np.where(seen > 0.0, means[5] + 0.3, 0.0)

    mean, variance = offset(means, own, seen)

    assert_allclose(mean[8:], means[4:8].mean(axis=0)[8:], atol=1.5)
    stranger, wide = offset(means, own + 60.0 * (seen > 0.0), seen)
    assert_allclose(stranger[8:], means.mean(axis=0)[8:], atol=1e-6)
    assert (wide[8:] > 5.0 * variance[8:]).all()


def test_two_gaussians_are_weighed_by_their_precision():
    """One example says nothing of the spread of others; with two, by hand."""
    means = np.array([[-3.0, 1.0], [3.0, 1.0]])
    own, seen = np.array([50.0, 1.0]), np.array([0.2, 0.2])

    mean, variance = offset(means, own, seen, noise=4.0)

    before = 2.0 * (8.0 / 2) ** 2 + 1e-3
    of_own = 16.0 * 10.0 * (1 / 20.0 - 1 / 100.0) + 4.0 / 20.0 + 1e-3
    together = 1.0 / (1.0 / before + 1.0 / of_own)
    assert_allclose(mean[0], together * (0.0 / before + 50.0 / of_own), rtol=1e-9)
    assert_allclose(variance[0], together, rtol=1e-9)


def test_a_take_that_was_never_seen_has_the_examples_mean(means):
    mean, variance = offset(means, np.zeros(12), np.zeros(12))

    assert_allclose(mean, means.mean(axis=0), atol=1e-6)
    assert_allclose(variance, 2.0 * np.maximum(means.var(axis=0), (8.0 / 12) ** 2) + 1e-3)


def test_clips_that_are_unlike_say_nothing_however_many_they_are(means, rng):
    seen = np.ones(12)
    seen[8:] = 0.0
    own = np.where(seen > 0.0, means[5] + 0.3, 0.0)
    unlike = means.mean(axis=0) + rng.normal(size=(5000, 12)) * 60.0 + 200.0

    mean, _ = offset(np.concatenate([unlike, means]), own, seen)

    assert_allclose(mean[8:], means[4:8].mean(axis=0)[8:], atol=20.0)


def test_one_example_does_not_know_how_everybody_holds_themselves(means):
    own = means[0] + 8.0

    mean, variance = offset(means[:1], own, np.full(12, 0.3))

    assert (np.abs(mean - own) < 4.0).all()
    assert (variance > 1.0).all()
