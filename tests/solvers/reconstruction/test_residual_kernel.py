"""Compare the residual prior's Gaussian process with explicit formulas."""

import numpy as np
import pytest

from solvers.reconstruction.residual_correction.kernel import (
    Kernel,
    _negative_log_likelihood,
    learn_kernel,
    squared_distances,
    squared_exponential,
)
from solvers.reconstruction.residual_correction.sparse_process import (
    MEAN_VARIANCE,
    basis_functions,
    inducing_points,
    posterior,
    shared_design,
)

KERNEL = Kernel((0.5, 1.5), (0.8, 0.3), (0.2, 0.1), 0.05, 0.1, 0.02)


@pytest.fixture
def examples():
    random = np.random.default_rng(3)
    local, complete = random.normal(size=(24, 3)), random.normal(size=(24, 2))
    takes = np.repeat(np.arange(6), 4)
    return local, complete, random.normal(size=(24, 3)), takes, takes // 3


def dense_covariance(local, complete, takes, actors, kernel):
    """Covariance K of all examples, computed pair by pair."""
    n = len(local)
    covariance = np.zeros((n, n))
    for a in range(n):
        for b in range(n):
            near = [
                np.exp(-((one[a] - one[b]) ** 2).sum() / (2.0 * size**2))
                for one, size in zip((local, complete), kernel.lengths, strict=True)
            ]
            covariance[a, b] = kernel.shared[0] * near[0] + kernel.shared[1] * near[1]
            if actors[a] == actors[b]:
                covariance[a, b] += kernel.personal[0] * near[0] + kernel.personal[1] * near[1]
                covariance[a, b] += kernel.actor
            covariance[a, b] += kernel.take * (takes[a] == takes[b]) + kernel.noise * (a == b)
    return covariance


def test_squared_distances_equal_those_of_all_pairs():
    one = np.array([[0.0, 0.0], [3.0, 4.0]])
    np.testing.assert_allclose(squared_distances(one, one), [[0.0, 25.0], [25.0, 0.0]])
    np.testing.assert_allclose(squared_exponential(one, one, 5.0)[0, 1], np.exp(-0.5))


def test_likelihood_equals_a_normal_density(examples):
    local, complete, errors, takes, actors = examples
    covariance = dense_covariance(local, complete, takes, actors, KERNEL)
    sign, log = np.linalg.slogdet(covariance)
    expected = 0.5 * np.trace(errors.T @ np.linalg.inv(covariance) @ errors) + 1.5 * log
    assert sign > 0
    assert negative_log_likelihood(logs_of(KERNEL), examples)[0] == pytest.approx(expected)


def test_gradient_equals_finite_differences(examples):
    logs = logs_of(KERNEL)
    _, gradient = negative_log_likelihood(logs, examples)
    for index, slope in enumerate(gradient):
        step = np.zeros(9)
        step[index] = 1e-5
        ahead, behind = (
            negative_log_likelihood(logs + sign * step, examples)[0] for sign in (1, -1)
        )
        assert slope == pytest.approx((ahead - behind) / 2e-5, rel=1e-4, abs=1e-5)


def test_learning_increases_the_likelihood_of_the_examples(examples):
    local, complete, errors, takes, actors = examples
    learned = learn_kernel((local, complete), errors, takes, actors, simple=False)
    assert (
        negative_log_likelihood(logs_of(learned), examples, centered=True)[0]
        < negative_log_likelihood(logs_of(KERNEL), examples, centered=True)[0]
    )


def test_optimization_recovers_the_noise():
    random = np.random.default_rng(0)
    local = random.uniform(-2.0, 2.0, size=(300, 1))
    errors = np.sin(2.0 * local) * [1.0, -1.0, 0.5] + random.normal(0.0, 0.2, size=(300, 3))
    one = np.zeros(300, int)
    learned = learn_kernel((local, local), errors, np.arange(300), one, simple=True)
    assert np.sqrt(learned.noise) == pytest.approx(0.2, rel=0.15)


def test_process_is_exact_with_an_inducing_point_at_each_example(examples):
    local, complete, errors, takes, actors = examples
    bases = (
        basis_functions(local, local, KERNEL.lengths[0]),
        basis_functions(complete, complete, KERNEL.lengths[1]),
    )
    mean, covariance = posterior(bases, errors, takes, actors, KERNEL, 1.0)
    new_local, new_complete = local[:5] + 0.3, complete[:5] - 0.2
    columns = shared_design(
        (
            basis_functions(new_local, local, KERNEL.lengths[0]),
            basis_functions(new_complete, complete, KERNEL.lengths[1]),
        ),
        KERNEL,
    )
    between = MEAN_VARIANCE + sum(
        shared * squared_exponential(new, old, size)
        for shared, new, old, size in zip(
            KERNEL.shared,
            (new_local, new_complete),
            (local, complete),
            KERNEL.lengths,
            strict=True,
        )
    )
    dense = dense_covariance(local, complete, takes, actors, KERNEL) + MEAN_VARIANCE
    solved = np.linalg.solve(dense, np.c_[errors, between.T])
    np.testing.assert_allclose(columns @ mean, between @ solved[:, :3], atol=2e-3)
    own = MEAN_VARIANCE + sum(KERNEL.shared)
    expected = own - np.einsum("ij,ji->i", between, solved[:, 3:])
    explained = np.einsum("ni,ij,nj->n", columns, covariance, columns)
    open_variance = sum(KERNEL.shared) + MEAN_VARIANCE - (columns**2).sum(axis=1)
    np.testing.assert_allclose(explained + open_variance, expected, atol=5e-3)


def test_constant_error_of_one_actor_is_not_generalized(examples):
    local, complete, _, takes, actors = examples
    errors = np.where(actors[:, None] == 0, 1.0, -1.0) * np.ones((24, 3))
    bases = (
        basis_functions(local, local, KERNEL.lengths[0]),
        basis_functions(complete, complete, KERNEL.lengths[1]),
    )
    mean, _ = posterior(bases, errors, takes, actors, KERNEL, 1.0)
    prediction = np.abs(shared_design(bases, KERNEL) @ mean).mean()
    unaware, _ = posterior(bases, errors, takes, np.zeros(24, int), KERNEL, 1.0)
    assert prediction < 0.6 * np.abs(shared_design(bases, KERNEL) @ unaware).mean()


def test_few_distinct_features_are_the_inducing_points():
    features = np.repeat(np.eye(3), 5, axis=0)
    assert sorted(map(tuple, inducing_points(features, 10, 0))) == sorted(map(tuple, np.eye(3)))


def logs_of(kernel):
    return np.log([
        *kernel.lengths,
        *kernel.shared,
        *kernel.personal,
        kernel.take,
        kernel.actor,
        kernel.noise,
    ])


def negative_log_likelihood(logs, examples, centered=False):
    local, complete, errors, takes, actors = examples
    distances = tuple(squared_distances(one, one) for one in (local, complete))
    same = tuple((one[:, None] == one).astype(float) for one in (takes, actors))
    return _negative_log_likelihood(
        logs, distances, same, errors - errors.mean(axis=0) * centered
    )
