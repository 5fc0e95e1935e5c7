"""The likelihoods and predictions equal those of dense Gaussian processes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import approx_fprime
from scipy.spatial.distance import cdist

from solvers.variation.stepwise_process import (
    JITTER,
    Hyperparameters,
    _latent_cost,
    _published_cost,
    learn_hyperparameters,
)
from solvers.variation.stepwise_stack import learn_stack


@pytest.fixture
def found(rng) -> Hyperparameters:
    mixing = np.eye(3) + 0.4 * rng.normal(size=(3, 3))
    return Hyperparameters(
        np.array([0.7, 1.1, 2.0]), np.array([0.3, 0.6, 0.2]), np.array([0.1, 0.2, 0.05]), mixing
    )


@pytest.fixture
def data(rng):
    return rng.normal(size=(9, 4)), rng.normal(size=(9, 3))


def processes(one, other, found):
    far = cdist(one, other, "sqeuclidean")
    return [
        np.exp(-0.5 * far / length**2) + bias
        for length, bias in zip(found.lengths, found.biases, strict=True)
    ]


def point(found):
    logs = np.log(np.concatenate([found.lengths, found.biases, found.noises]))
    return np.concatenate([logs, found.mixing.ravel()])


def gaussian_cost(covariance, values):
    return 0.5 * (
        values @ np.linalg.solve(covariance, values) + np.linalg.slogdet(covariance)[1]
    )


def test_the_latent_factor_likelihood_is_that_of_all_outputs_together(data, found):
    features, outputs = data
    weights = np.linalg.inv(found.mixing)
    covariance = sum(
        np.kron(kernel + (noise + JITTER) * np.eye(9), np.outer(column, column))
        for kernel, noise, column in zip(
            processes(features, features, found), found.noises, weights.T, strict=True
        )
    )

    cost, _ = _latent_cost(point(found), cdist(features, features, "sqeuclidean"), outputs)

    assert_allclose(cost, gaussian_cost(covariance, outputs.ravel()), rtol=1e-8)


def test_the_published_likelihood_is_that_of_three_outputs_that_share_kernels(data, found):
    features, outputs = data
    kernels = processes(features, features, found)
    dense = 0.0
    for row, values in zip(found.mixing**2, outputs.T, strict=True):
        covariance = JITTER * np.eye(9) + sum(
            weight * (kernel + noise * np.eye(9))
            for weight, kernel, noise in zip(row, kernels, found.noises, strict=True)
        )
        dense += gaussian_cost(covariance, values)

    cost, _ = _published_cost(point(found), cdist(features, features, "sqeuclidean"), outputs)

    assert_allclose(cost, dense, rtol=1e-8)


@pytest.mark.parametrize("cost", [_latent_cost, _published_cost])
def test_gradients_are_those_of_differences(cost, data, found):
    far = cdist(data[0], data[0], "sqeuclidean")

    slope = cost(point(found), far, data[1])[1]

    differences = approx_fprime(point(found), lambda x: cost(x, far, data[1])[0], 1e-6)
    assert_allclose(slope, differences, atol=2e-4)


@pytest.mark.parametrize("published", [True, False])
def test_learning_raises_the_likelihood(published, rng):
    features = rng.normal(size=(40, 2))
    outputs = np.sin(features @ rng.normal(size=(2, 3))) + 0.05 * rng.normal(size=(40, 3))
    far = cdist(features, features, "sqeuclidean")
    cost = _published_cost if published else _latent_cost

    costs = [
        cost(point(learn_hyperparameters(features, outputs, published, rounds)), far, outputs)[
            0
        ]
        for rounds in (1, 5, 40)
    ]

    assert costs[2] < costs[1] < costs[0]


@pytest.mark.parametrize("published", [True, False])
def test_with_all_examples_inducing_the_prediction_is_exact(published, data, found, rng):
    features, outputs = data
    stack, _ = one_stack(features, outputs, found, published)
    new = rng.normal(size=(5, 4))
    seen, there = ((x - features.mean(0)) / features.std(0) for x in (features, new))
    scale, middle = outputs.std(axis=0).max(), outputs.mean(axis=0)
    weights = found.mixing**2 if published else np.eye(3)
    mixing = np.eye(3) if published else np.linalg.inv(found.mixing)
    channels = np.linalg.solve(mixing, ((outputs - middle) / scale).T)
    expected = []
    for row, told in zip(weights, channels, strict=True):
        own, other = (
            np.tensordot(row, np.stack(processes(x, seen, found)), axes=1)
            for x in (seen, there)
        )
        noise = row @ found.noises
        expected.append(other @ np.linalg.solve(own + noise * np.eye(9), told))

    got = stack.expected(new)[:, 0]

    assert_allclose(got, scale * (mixing @ expected).T + middle, atol=1e-4)


def test_drawn_functions_have_the_exact_covariance(data, found, rng):
    features, outputs = data
    stack, _ = one_stack(features, outputs, found, published=False)
    seen = (features - features.mean(0)) / features.std(0)
    kernel, noise = processes(seen, seen, found)[0], found.noises[0]
    exact = kernel - kernel @ np.linalg.solve(kernel + noise * np.eye(9), kernel)

    functions = stack.draw_functions(20_000, rng)[0, 0]
    values = functions @ stack.kernels(features)[0, 0].T

    assert_allclose(np.cov(values.T), exact, atol=0.01)


def test_outputs_covary_only_in_the_latent_factor_model(rng):
    """Two outputs that are one and the same up to a factor: what is drawn must be so too."""
    features = rng.normal(size=(60, 3))
    course = np.sin(2.0 * features[:, 0]) + 0.3 * rng.normal(size=60)
    outputs = np.column_stack([course, 2.0 * course, 0.1 * rng.normal(size=60)])
    far_away = np.full((4000, 3), 4.0) + rng.normal(size=(4000, 3))
    together = {}
    for published in (True, False):
        stack, _ = one_stack(features, outputs, None, published)
        drawn = stack.sampled(far_away, rng)[:, 0]
        together[published] = np.corrcoef(drawn[:, 0], drawn[:, 1])[0, 1]

    assert together[False] > 0.95
    assert abs(together[True]) < 0.3


def one_stack(features, outputs, found, published):
    columns = np.arange(features.shape[1])[None]
    return learn_stack(
        features, outputs[:, None], columns, np.ones(features.shape[1]), published,
        [found] if found else None,
    )  # fmt: skip
