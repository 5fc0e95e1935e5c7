"""The likelihoods and predictions equal those of dense Gaussian processes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import approx_fprime
from scipy.spatial.distance import cdist

from solvers.variation.published.process import (
    REGULARIZATION,
    Hyperparameters,
    _latent_cost,
    _published_cost,
    learn_hyperparameters,
)
from solvers.variation.published.stack import learn_stack


@pytest.fixture
def hyperparameters(rng) -> Hyperparameters:
    mixing = np.eye(3) + 0.4 * rng.normal(size=(3, 3))
    return Hyperparameters(
        np.array([0.7, 1.1, 2.0]), np.array([0.3, 0.6, 0.2]), np.array([0.1, 0.2, 0.05]), mixing
    )


@pytest.fixture
def data(rng):
    return rng.normal(size=(9, 4)), rng.normal(size=(9, 3))


def processes(one, other, hyperparameters):
    distances = cdist(one, other, "sqeuclidean")
    return [
        np.exp(-0.5 * distances / length**2) + bias
        for length, bias in zip(hyperparameters.lengths, hyperparameters.biases, strict=True)
    ]


def point(hyperparameters):
    logs = np.log(
        np.concatenate([
            hyperparameters.lengths,
            hyperparameters.biases,
            hyperparameters.noises,
        ])
    )
    return np.concatenate([logs, hyperparameters.mixing.ravel()])


def gaussian_cost(covariance, values):
    return 0.5 * (
        values @ np.linalg.solve(covariance, values) + np.linalg.slogdet(covariance)[1]
    )


def test_latent_factor_likelihood_equals_the_joint_likelihood(data, hyperparameters):
    features, outputs = data
    weights = np.linalg.inv(hyperparameters.mixing)
    covariance = sum(
        np.kron(kernel + (noise + REGULARIZATION) * np.eye(9), np.outer(column, column))
        for kernel, noise, column in zip(
            processes(features, features, hyperparameters),
            hyperparameters.noises,
            weights.T,
            strict=True,
        )
    )

    cost, _ = _latent_cost(
        point(hyperparameters), cdist(features, features, "sqeuclidean"), outputs
    )

    assert_allclose(cost, gaussian_cost(covariance, outputs.ravel()), rtol=1e-8)


def test_published_likelihood_equals_that_of_three_outputs(data, hyperparameters):
    features, outputs = data
    kernels = processes(features, features, hyperparameters)
    dense = 0.0
    for row, values in zip(hyperparameters.mixing**2, outputs.T, strict=True):
        covariance = REGULARIZATION * np.eye(9) + sum(
            weight * (kernel + noise * np.eye(9))
            for weight, kernel, noise in zip(row, kernels, hyperparameters.noises, strict=True)
        )
        dense += gaussian_cost(covariance, values)

    cost, _ = _published_cost(
        point(hyperparameters), cdist(features, features, "sqeuclidean"), outputs
    )

    assert_allclose(cost, dense, rtol=1e-8)


@pytest.mark.parametrize("cost", [_latent_cost, _published_cost])
def test_gradients_equal_finite_differences(cost, data, hyperparameters):
    distances = cdist(data[0], data[0], "sqeuclidean")

    slope = cost(point(hyperparameters), distances, data[1])[1]

    differences = approx_fprime(
        point(hyperparameters), lambda x: cost(x, distances, data[1])[0], 1e-6
    )
    assert_allclose(slope, differences, atol=2e-4)


@pytest.mark.parametrize("published", [True, False])
def test_learning_increases_the_likelihood(published, rng):
    features = rng.normal(size=(40, 2))
    outputs = np.sin(features @ rng.normal(size=(2, 3))) + 0.05 * rng.normal(size=(40, 3))
    distances = cdist(features, features, "sqeuclidean")
    cost = _published_cost if published else _latent_cost

    costs = [
        cost(
            point(learn_hyperparameters(features, outputs, published, rounds)),
            distances,
            outputs,
        )[0]
        for rounds in (1, 5, 40)
    ]

    assert costs[2] < costs[1] < costs[0]


@pytest.mark.parametrize("published", [True, False])
def test_prediction_is_exact_when_all_examples_are_inducing(
    published, data, hyperparameters, rng
):
    features, outputs = data
    stack, _ = one_stack(features, outputs, hyperparameters, published)
    new = rng.normal(size=(5, 4))
    observed, new_features = ((x - features.mean(0)) / features.std(0) for x in (features, new))
    scale, middle = outputs.std(axis=0).max(), outputs.mean(axis=0)
    weights = hyperparameters.mixing**2 if published else np.eye(3)
    mixing = np.eye(3) if published else np.linalg.inv(hyperparameters.mixing)
    channels = np.linalg.solve(mixing, ((outputs - middle) / scale).T)
    predict = []
    for row, result in zip(weights, channels, strict=True):
        own, other = (
            np.tensordot(row, np.stack(processes(x, observed, hyperparameters)), axes=1)
            for x in (observed, new_features)
        )
        noise = row @ hyperparameters.noises
        predict.append(other @ np.linalg.solve(own + noise * np.eye(9), result))

    got = stack.predict(new)[:, 0]

    assert_allclose(got, scale * (mixing @ predict).T + middle, atol=1e-4)


def test_drawn_functions_have_the_exact_covariance(data, hyperparameters, rng):
    features, outputs = data
    stack, _ = one_stack(features, outputs, hyperparameters, published=False)
    observed = (features - features.mean(0)) / features.std(0)
    kernel, noise = processes(observed, observed, hyperparameters)[0], hyperparameters.noises[0]
    exact = kernel - kernel @ np.linalg.solve(kernel + noise * np.eye(9), kernel)

    functions = stack.draw_functions(20_000, rng)[0, 0]
    values = functions @ stack.kernels(features)[0, 0].T

    assert_allclose(np.cov(values.T), exact, atol=0.01)


def test_outputs_covary_only_in_the_latent_factor_model(rng):
    """Two outputs that are proportional: so must be the samples."""
    features = rng.normal(size=(60, 3))
    curves = np.sin(2.0 * features[:, 0]) + 0.3 * rng.normal(size=60)
    outputs = np.column_stack([curves, 2.0 * curves, 0.1 * rng.normal(size=60)])
    far_away = np.full((4000, 3), 4.0) + rng.normal(size=(4000, 3))
    together = {}
    for published in (True, False):
        stack, _ = one_stack(features, outputs, None, published)
        drawn = stack.draw_outputs(far_away, rng)[:, 0]
        together[published] = np.corrcoef(drawn[:, 0], drawn[:, 1])[0, 1]

    assert together[False] > 0.95
    assert abs(together[True]) < 0.3


def one_stack(features, outputs, hyperparameters, published):
    columns = np.arange(features.shape[1])[None]
    return learn_stack(
        features, outputs[:, None], columns, np.ones(features.shape[1]), published,
        [hyperparameters] if hyperparameters else None,
    )  # fmt: skip
