"""How far joints are believed about each other, and which examples are used at all."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising.posterior.channel_groups import LARGEST_GROUP, groups_of
from solvers.denoising.posterior.prior_selection import (
    BLUR,
    choose_prior,
    foresight,
    joint_foresight,
)
from solvers.denoising.posterior.smoothness import LENGTHS, smooth_kernels
from solvers.denoising.posterior.windows import Windows
from solvers.denoising.prior.window_prior import Smoothness, WavePrior, mixed, smooth_prior
from solvers.progress import unwatched

LENGTH, RATE = 10, 30.0
JOINTS = np.array([0, 0, 1, 2, 2])
WINDOWS = Windows(200, LENGTH, 1.0)


@pytest.mark.parametrize("density", [1.0, 2.0])
def test_foresight_is_that_of_leaving_a_joint_out(rng, density):
    """Against a dense conditional Gaussian, one window and one joint at a time."""
    prior, rough, noise = coupled(rng), some_take(rng), np.full(5, 0.2)
    windows = Windows(200, round(LENGTH * density), density)

    found = joint_foresight(prior, rough, noise, JOINTS, windows)

    n_slow, n_channels = prior.n_slow, 5
    power = np.einsum("kckc->c", prior.slow) / LENGTH
    spread = np.tile((noise**2 + BLUR**2 * power) / density, n_slow)
    covariance = prior.matrix + np.diag(spread)
    waves = windows.waves_of(windows.cut(rough - prior.mean, windows.starts))[:, :n_slow]
    waves = waves.reshape(len(waves), -1)
    missed = whole = 0.0
    for joint in range(3):
        inside = np.flatnonzero(np.tile(joint == JOINTS, n_slow))
        others = np.setdiff1d(np.arange(n_slow * n_channels), inside)
        gain = np.linalg.solve(
            covariance[np.ix_(others, others)], covariance[np.ix_(others, inside)]
        )
        missed += ((waves[:, inside] - waves[:, others] @ gain) ** 2).sum()
        whole += (waves[:, inside] ** 2).sum()
    assert_allclose(found, missed / whole, rtol=1e-6)


def test_foretelling_outliers_does_not_count():
    noise, surprise = np.array([1.0, 2.0]), np.array([[1.0, 2.0], [50.0, np.nan], [0.0, 4.0]])
    inside = np.array([[1.0, 1.0], [0.0, 0.0], [1.0, 0.5]])

    found = foresight(surprise, inside, noise)

    assert_allclose(found, (1.0 + 1.0 + 0.0 + 0.5 * 4.0) / 16.0 / 3.5)


def test_channels_that_know_nothing_of_each_other_foretell_nothing(rng):
    prior = smooth(np.ones(5))

    found = joint_foresight(prior, some_take(rng), np.full(5, 0.2), JOINTS, WINDOWS)

    assert_allclose(found, 1.0, atol=1e-9)


def test_a_mixture_lies_between_both(rng):
    examples = coupled(rng)
    plain = smooth(np.ones(5))

    both = mixed(examples, plain, 0.25)

    assert_allclose(both.slow, 0.75 * examples.slow + 0.25 * plain.slow)
    assert_allclose(both.fast, 0.75 * examples.fast + 0.25 * plain.fast)
    assert_allclose(both.mean, examples.mean)


def test_only_the_smooth_share_is_fitted(rng):
    """Twice the smoothness is a share of it more, on each channel by itself."""
    plain = smooth(np.ones(5))
    both = mixed(coupled(rng), plain, 0.25)

    fitted = both.with_smoothness(2.0 * both.smooth.weights)

    assert_allclose(fitted.slow - both.slow, 0.25 * plain.slow, atol=1e-12)
    assert_allclose(fitted.fast - both.fast, 0.25 * plain.fast, atol=1e-12)
    again = fitted.with_smoothness(both.smooth.weights)
    assert_allclose(again.slow, both.slow, atol=1e-12)


def test_examples_of_the_movement_win_and_of_stillness_lose(rng):
    prior = coupled(rng)
    take = drawn(prior, rng)
    noisy, noise = take + 0.5 * rng.normal(size=take.shape), np.full(5, 0.5)
    own = smooth(take.var(axis=0))
    still = replace(prior, slow=1e-4 * prior.slow, fast=1e-4 * prior.fast)

    shares = [
        choose_prior(examples, own, noisy, take, noise, JOINTS, WINDOWS, unwatched)[1]
        for examples in (prior, still)
    ]

    assert shares[0] < 0.1
    assert shares[1] == 1.0


def test_no_group_cuts_through_a_joint(rng):
    """Of a hundred joints some turn about one axis, some about two, some about three."""
    values = rng.normal(size=(20, 100, 3))
    values[:, ::3, 1:] = 0.0
    values[:, 1::3, 2] = 0.0
    flat = values.reshape(20, 300)

    groups = groups_of(flat, flat, np.zeros(300, dtype=bool))

    joints = [set((group // 3).tolist()) for group in groups]
    assert len(groups) > 1
    assert max(map(len, groups)) <= LARGEST_GROUP
    assert sum(map(len, joints)) == len(set.union(*joints)) == 100
    moving = np.flatnonzero(np.ptp(flat, axis=0) > 0)
    assert np.concatenate(groups).tolist() == moving.tolist()


def test_what_fits_into_one_group_is_one(rng):
    """Thirty joints, of which most are hinges."""
    values = np.zeros((20, 30, 3))
    values[:, :, 0] = rng.normal(size=(20, 30))
    values[:, :20, 1:] = rng.normal(size=(20, 20, 2))
    flat = values.reshape(20, 90)

    (group,) = groups_of(flat, flat, np.zeros(90, dtype=bool))

    assert len(group) == 70


def smooth(variance) -> WavePrior:
    """Five channels that move smoothly, each by itself."""
    kernels = smooth_kernels(LENGTH, RATE)
    weights = np.repeat(variance[None] / len(kernels), len(kernels), axis=0)
    return smooth_prior(np.zeros(5), Smoothness(kernels, weights), 0.05, 0.5)


def coupled(rng) -> WavePrior:
    """Five channels that move as two things do."""
    plain = smooth(np.ones(5))
    mix = rng.normal(size=(5, 2))
    together = mix @ mix.T + 0.05 * np.eye(5)
    kernel = plain.slow[:, 0, :, 0]
    return WavePrior(
        np.array([1.0, -2.0, 0.5, 3.0, 0.0]),
        np.einsum("kj,cd->kcjd", kernel, together),
        plain.fast * np.diag(together),
        np.full(5, 0.05), np.full(5, 0.05), np.ones(5), replace(plain.smooth, share=0.0),
    )  # fmt: skip


def drawn(prior: WavePrior, rng):
    """A take of the prior's two things, smooth over time."""
    times = np.arange(200) / RATE
    steps = np.subtract.outer(times, times)
    kernel = sum(np.exp(-0.5 * (steps / length) ** 2) for length in LENGTHS) / len(LENGTHS)
    together = prior.slow[0, :, 0] / prior.slow[0, 0, 0, 0]
    both = np.linalg.cholesky(together + 1e-9 * np.eye(5))
    smooth = np.linalg.cholesky(kernel + 1e-6 * np.eye(200)) @ rng.normal(size=(200, 5))
    return smooth @ both.T * np.sqrt(prior.slow[0, 0, 0, 0] / LENGTH) + prior.mean


def some_take(rng):
    return np.cumsum(rng.normal(size=(200, 5)), axis=0) * 0.3
