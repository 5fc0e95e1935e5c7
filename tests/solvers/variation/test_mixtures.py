"""Mixing weights of examples."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.variation.curves.partitions import ROOT_ROW
from solvers.variation.mixing_kernel import MixingKernel
from solvers.variation.mixtures import draw_mixing_weights, mix_deviations


def test_all_examples_have_equal_weight_on_average(model, rng):
    weights = draw_mixing_weights(model, 300, rng)[ROOT_ROW]
    first = weights.argmax(axis=-1).ravel()

    counts = np.bincount(first, minlength=model.n_examples) / len(first)

    assert_allclose(counts, 1.0 / model.n_examples, atol=0.08)


def test_mixture_with_weight_one_is_the_example(model):
    weights = np.zeros((ROOT_ROW + 1, 1, model.n_samples, model.n_examples))
    weights[..., 2] = 1.0

    joints, root, log_warp_rates, contact_state = mix_deviations(model, weights)

    assert_allclose(model.joints.mean(axis=0) + joints[0], model.joints[2], atol=1e-12)
    assert_allclose(model.root.mean(axis=0) + root[0], model.root[2], atol=1e-12)
    assert_allclose(
        model.log_warp_rates.mean(axis=0) + log_warp_rates[0],
        model.log_warp_rates[2],
        atol=1e-12,
    )
    assert_allclose(
        model.contact_state.mean(axis=0) + contact_state[0], model.contact_state[2], atol=1e-12
    )


def test_weights_change_slowly(model, rng):
    """Within a tenth of a second, six frames at 60 Hz, a weight changes by a small fraction."""
    weights = draw_mixing_weights(model, 100, rng)
    steps = np.abs(weights[:, :, 6:] - weights[:, :, :-6])

    assert steps.mean() < 0.1
    assert np.ptp(weights, axis=2).mean() > 0.2


def test_weights_of_arms_differ_more_than_those_of_legs(model, rng):
    weights = draw_mixing_weights(model, 300, rng)
    differences = [
        np.abs(weights[left] - weights[right]).mean() for left, right in ((1, 2), (3, 4))
    ]

    assert differences[0] > 1.3 * differences[1]


def test_weights_of_a_loop_are_periodic(model, rng):
    assert model.loops

    weights = draw_mixing_weights(model, 50, rng)

    assert np.abs(weights[:, :, -1] - weights[:, :, 0]).max() < 0.02


def test_kernel_equals_its_closed_form():
    kernel = MixingKernel(scale=0.5, bias=0.3)
    times = np.array([0.0, 0.5, 2.0])

    covariance = kernel.covariance(times)

    assert_allclose(np.diag(covariance), 1.0)
    assert covariance[0, 1] == pytest.approx(0.3 + 0.7 * np.exp(-0.5))
    assert kernel.covariance(times, period=2.0)[0, 2] == pytest.approx(1.0)
