"""Outliers of one channel make those of its joint likely, if they correlate in the take."""

import numpy as np
from numpy.testing import assert_allclose

from solvers.denoising.posterior.joint_outliers import JointOutlierPrior

JOINTS = np.array([0, 0, 0, 1, 2, 2])
RATE = 0.05
OBSERVED = np.ones((1000, len(JOINTS)), dtype=bool)
NO_OUTLIERS = np.zeros(OBSERVED.shape)


def test_correlated_outliers_raise_the_rates_of_their_joint(rng):
    outliers = (rng.random((1000, 3)) < RATE).astype(float)[:, JOINTS]

    outlier_rates = JointOutlierPrior(JOINTS, NO_OUTLIERS).outlier_rates(
        outliers, OBSERVED, RATE
    )

    joint_outliers = outliers[:, [1, 0, 0, 3, 5, 4]] * [1, 1, 1, 0, 1, 1]
    has_siblings = JOINTS != 1
    assert outlier_rates[joint_outliers == 1.0].min() > 0.7
    assert (
        outlier_rates[:, has_siblings][joint_outliers[:, has_siblings] == 0.0].max()
        < 0.5 * RATE
    )
    assert_allclose(outlier_rates.mean(), RATE, rtol=0.3)


def test_independent_outliers_leave_the_rates_unchanged(rng):
    outliers = (rng.random((1000, 6)) < RATE).astype(float)

    outlier_rates = JointOutlierPrior(JOINTS, NO_OUTLIERS).outlier_rates(
        outliers, OBSERVED, RATE
    )

    assert_allclose(outlier_rates, RATE, atol=0.03)


def test_few_outliers_hardly_change_the_rates():
    outliers = np.zeros(OBSERVED.shape)
    outliers[500, :3] = 1.0

    assert (
        JointOutlierPrior(JOINTS, NO_OUTLIERS).outlier_rates(outliers, OBSERVED, RATE).max()
        < 0.1
    )


def test_outliers_of_earlier_groups_raise_the_rates(rng):
    outliers = (rng.random((1000, 3)) < RATE).astype(float)[:, [0, 0, 1]]
    joints, observed = np.array([0, 1, 2]), OBSERVED[:, :3]

    outlier_rates = JointOutlierPrior(joints, outliers).outlier_rates(outliers, observed, RATE)

    assert outlier_rates[outliers == 1.0].min() > 0.7
    assert outlier_rates[outliers == 0.0].max() < 0.5 * RATE


def test_first_and_last_channel_of_a_joint_are_correlated(rng):
    outliers = (rng.random((1000, 1)) < RATE) * np.array([1.0, 0.0, 1.0])

    outlier_rates = JointOutlierPrior(np.zeros(3, dtype=int), NO_OUTLIERS[:, :3]).outlier_rates(
        outliers, OBSERVED[:, :3], RATE
    )

    assert outlier_rates[:, [0, 2]][outliers[:, [0, 2]] == 1.0].min() > 0.4


def test_rates_without_observations_are_unchanged():
    outlier_rates = JointOutlierPrior(JOINTS, NO_OUTLIERS).outlier_rates(
        NO_OUTLIERS, OBSERVED & False, RATE
    )

    assert_allclose(outlier_rates, RATE)
