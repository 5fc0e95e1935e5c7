"""Shares of examples in a mixture."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.variation import learn_variation_model
from solvers.variation.mixing_kernel import MixingKernel
from solvers.variation.mixtures import COMMON, draw_shares, mixed_deviations


def test_each_example_has_its_turn(model, rng):
    shares = draw_shares(model, 300, rng)[COMMON]
    first = shares.argmax(axis=-1).ravel()

    counts = np.bincount(first, minlength=model.n_examples) / len(first)

    assert_allclose(counts, 1.0 / model.n_examples, atol=0.08)


def test_a_share_of_one_is_the_example(model):
    shares = np.zeros((COMMON + 1, 1, model.n_moments, model.n_examples))
    shares[..., 2] = 1.0

    joints, root, haste, footing = mixed_deviations(model, shares)

    assert_allclose(model.joints.mean(axis=0) + joints[0], model.joints[2], atol=1e-12)
    assert_allclose(model.root.mean(axis=0) + root[0], model.root[2], atol=1e-12)
    assert_allclose(model.haste.mean(axis=0) + haste[0], model.haste[2], atol=1e-12)
    assert_allclose(model.footing.mean(axis=0) + footing[0], model.footing[2], atol=1e-12)


def test_shares_change_slowly(model, rng):
    """Within a tenth of a second, six frames at 60 Hz, a share changes by a small part."""
    shares = draw_shares(model, 100, rng)
    steps = np.abs(shares[:, :, 6:] - shares[:, :, :-6])

    assert steps.mean() < 0.1
    assert np.ptp(shares, axis=2).mean() > 0.2


def test_arms_part_from_each_other_more_than_legs_do(model, rng):
    shares = draw_shares(model, 300, rng)
    apart = [np.abs(shares[left] - shares[right]).mean() for left, right in ((1, 2), (3, 4))]

    assert apart[0] > 1.3 * apart[1]


def test_shares_of_a_loop_end_as_they_begin(walks, rng):
    model = learn_variation_model(walks)
    assert model.loops

    shares = draw_shares(model, 50, rng)

    assert np.abs(shares[:, :, -1] - shares[:, :, 0]).max() < 0.02


def test_kernel_in_closed_form():
    kernel = MixingKernel(scale=0.5, bias=0.3)
    times = np.array([0.0, 0.5, 2.0])

    covariance = kernel.covariance(times)

    assert_allclose(np.diag(covariance), 1.0)
    assert covariance[0, 1] == pytest.approx(0.3 + 0.7 * np.exp(-0.5))
    assert kernel.covariance(times, period=2.0)[0, 2] == pytest.approx(1.0)
