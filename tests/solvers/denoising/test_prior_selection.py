"""Select examples, and weight the joints, by their prediction error."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising.window_estimates.channel_groups import MAX_GROUP_CHANNELS, group_channels
from solvers.denoising.window_estimates.prior_selection import (
    build_take_prior,
    score_leave_joint_out,
    score_leave_one_out,
    select_prior,
)
from solvers.denoising.window_estimates.rough_take import RoughTake
from solvers.denoising.window_estimates.smoothness import (
    CORRELATION_TIMES_S,
    build_smooth_kernels,
)
from solvers.denoising.window_priors import Windows
from solvers.denoising.window_priors.window_prior import (
    SmoothPrior,
    WindowPrior,
    build_smooth_prior,
    mix_priors,
)
from solvers.progress import unwatched

LENGTH, RATE = 10, 30.0
JOINTS = np.array([0, 0, 1, 2, 2])
WINDOWS = Windows(200, LENGTH, 1.0)


@pytest.mark.parametrize("density", [1.0, 2.0])
def test_joint_score_equals_the_error_of_leaving_a_joint_out(rng, density):
    """The reference is a dense conditional Gaussian, one window and one joint at a time."""
    prior, rough, noise = coupled_channels(rng), random_walk(rng), np.full(5, 0.2)
    windows = Windows(200, round(LENGTH * density), density)

    score = score_leave_joint_out(prior, rough, noise, JOINTS, windows)

    n_slow, n_channels = prior.n_slow, 5
    spread = np.tile(noise**2 / density, n_slow)
    covariance = prior.matrix + np.diag(spread)
    coefficients = windows.coefficients_from_frames(
        windows.extract(rough - prior.mean, windows.starts)
    )[:, :n_slow]
    coefficients = coefficients.reshape(len(coefficients), -1)
    residual_power = total_power = 0.0
    for joint in range(3):
        inlier_probability = np.flatnonzero(np.tile(joint == JOINTS, n_slow))
        others = np.setdiff1d(np.arange(n_slow * n_channels), inlier_probability)
        gain = np.linalg.solve(
            covariance[np.ix_(others, others)], covariance[np.ix_(others, inlier_probability)]
        )
        residual_power += (
            (coefficients[:, inlier_probability] - coefficients[:, others] @ gain) ** 2
        ).sum()
        total_power += (coefficients[:, inlier_probability] ** 2).sum()
    assert_allclose(score, residual_power / total_power, rtol=1e-6)


def test_score_ignores_outliers():
    noise, leave_one_out_error = (
        np.array([1.0, 2.0]),
        np.array([[1.0, 2.0], [50.0, np.nan], [0.0, 4.0]]),
    )
    inlier_probability = np.array([[1.0, 1.0], [0.0, 0.0], [1.0, 0.5]])

    score = score_leave_one_out(leave_one_out_error, inlier_probability, noise)

    assert_allclose(score, (1.0 + 1.0 + 0.0 + 0.5 * 4.0) / 16.0 / 3.5)


def test_joint_score_of_independent_channels_is_one(rng):
    prior = smooth_channels(np.ones(5))

    score = score_leave_joint_out(prior, random_walk(rng), np.full(5, 0.2), JOINTS, WINDOWS)

    assert_allclose(score, 1.0, atol=1e-9)


def test_mixture_is_the_weighted_mean_of_both(rng):
    examples = coupled_channels(rng)
    plain = smooth_channels(np.ones(5))

    mixture = mix_priors(examples, plain, 0.25)

    assert_allclose(mixture.slow, 0.75 * examples.slow + 0.25 * plain.slow)
    assert_allclose(mixture.fast, 0.75 * examples.fast + 0.25 * plain.fast)
    assert_allclose(mixture.mean, examples.mean)


def test_only_the_smooth_fraction_is_fitted(rng):
    """Doubled smoothness adds its fraction once more to each channel."""
    plain = smooth_channels(np.ones(5))
    mixture = mix_priors(coupled_channels(rng), plain, 0.25)

    fitted = mixture.with_smoothness(2.0 * mixture.smooth.weights)

    assert_allclose(fitted.slow - mixture.slow, 0.25 * plain.slow, atol=1e-12)
    assert_allclose(fitted.fast - mixture.fast, 0.25 * plain.fast, atol=1e-12)
    again = fitted.with_smoothness(mixture.smooth.weights)
    assert_allclose(again.slow, mixture.slow, atol=1e-12)


def test_selects_examples_of_the_movement_but_not_of_stillness(rng):
    prior = coupled_channels(rng)
    take = sample_take(prior, rng)
    noisy, no_errors = take + 0.5 * rng.normal(size=take.shape), np.zeros(take.shape, bool)
    rough = RoughTake(noisy, no_errors, take, np.full(5, 0.5), np.full(5, len(take)), WINDOWS)
    own = smooth_channels(take.var(axis=0))
    still = replace(prior, slow=1e-4 * prior.slow, fast=1e-4 * prior.fast)

    fractions = [
        select_prior(examples, own, rough, JOINTS, unwatched)[1] for examples in (prior, still)
    ]

    assert fractions[0] < 0.1
    assert fractions[1] == 1.0


def test_own_covariance_of_a_long_take_does_not_outweigh_its_smoothness(rng):
    """Twenty minutes at 30 Hz."""
    rough, is_observed = rng.normal(size=(36000, 3)), np.ones(3, dtype=bool)
    windows = Windows(len(rough), LENGTH, 1.0)

    prior = build_take_prior(rough, np.ones(3), is_observed, windows, LENGTH, RATE)

    assert 0.2 < prior.own_weight < 0.5


def test_groups_keep_joints_together(rng):
    """Of a hundred joints some rotate about one axis, some about two, some about three."""
    values = rng.normal(size=(20, 100, 3))
    values[:, ::3, 1:] = 0.0
    values[:, 1::3, 2] = 0.0
    flat = values.reshape(20, 300)

    groups = group_channels(flat, flat, np.zeros(300, dtype=bool))

    joints = [set((group // 3).tolist()) for group in groups]
    assert len(groups) > 1
    assert max(map(len, groups)) <= MAX_GROUP_CHANNELS
    assert sum(map(len, joints)) == len(set.union(*joints)) == 100
    moving = np.flatnonzero(np.ptp(flat, axis=0) > 0)
    assert np.concatenate(groups).tolist() == moving.tolist()


def test_channels_within_the_limit_are_one_group(rng):
    """Thirty joints, most of them hinges."""
    values = np.zeros((20, 30, 3))
    values[:, :, 0] = rng.normal(size=(20, 30))
    values[:, :20, 1:] = rng.normal(size=(20, 20, 2))
    flat = values.reshape(20, 90)

    (group,) = group_channels(flat, flat, np.zeros(90, dtype=bool))

    assert len(group) == 70


def smooth_channels(variance) -> WindowPrior:
    """Return the prior of five channels that move smoothly and independently."""
    kernels = build_smooth_kernels(LENGTH, RATE)
    weights = np.repeat(variance[None] / len(kernels), len(kernels), axis=0)
    return build_smooth_prior(np.zeros(5), SmoothPrior(kernels, weights), 0.05, 0.5)


def coupled_channels(rng) -> WindowPrior:
    """Return the prior of five channels driven by two sources."""
    plain = smooth_channels(np.ones(5))
    mix = rng.normal(size=(5, 2))
    together = mix @ mix.T + 0.05 * np.eye(5)
    kernel = plain.slow[:, 0, :, 0]
    return WindowPrior(
        np.array([1.0, -2.0, 0.5, 3.0, 0.0]),
        np.einsum("kj,cd->kcjd", kernel, together),
        plain.fast * np.diag(together),
        0.05, 0.05, np.ones(5), replace(plain.smooth, fraction=0.0),
    )  # fmt: skip


def sample_take(prior: WindowPrior, rng):
    """Sample a take of the prior's two sources, smooth over time."""
    times = np.arange(200) / RATE
    steps = np.subtract.outer(times, times)
    kernel = sum(np.exp(-0.5 * (steps / length) ** 2) for length in CORRELATION_TIMES_S) / len(
        CORRELATION_TIMES_S
    )
    together = prior.slow[0, :, 0] / prior.slow[0, 0, 0, 0]
    mixture = np.linalg.cholesky(together + 1e-9 * np.eye(5))
    smooth = np.linalg.cholesky(kernel + 1e-6 * np.eye(200)) @ rng.normal(size=(200, 5))
    return smooth @ mixture.T * np.sqrt(prior.slow[0, 0, 0, 0] / LENGTH) + prior.mean


def random_walk(rng):
    return np.cumsum(rng.normal(size=(200, 5)), axis=0) * 0.3
