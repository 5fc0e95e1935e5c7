"""Outliers of one channel make those of its joint likely, if the take shows it."""

import numpy as np
from numpy.testing import assert_allclose

from solvers.denoising.posterior.joint_outliers import JointOutlierPrior

JOINTS = np.array([0, 0, 0, 1, 2, 2])
RATE = 0.05
OBSERVED = np.ones((1000, len(JOINTS)), dtype=bool)
NO_OUTLIERS = np.zeros(OBSERVED.shape)


def test_joints_that_are_wrong_as_a_whole_are_known(rng):
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


def test_channels_that_are_wrong_by_themselves_say_nothing(rng):
    outliers = (rng.random((1000, 6)) < RATE).astype(float)

    outlier_rates = JointOutlierPrior(JOINTS, NO_OUTLIERS).outlier_rates(
        outliers, OBSERVED, RATE
    )

    assert_allclose(outlier_rates, RATE, atol=0.03)


def test_few_outliers_prove_nothing():
    outliers = np.zeros(OBSERVED.shape)
    outliers[500, :3] = 1.0

    assert (
        JointOutlierPrior(JOINTS, NO_OUTLIERS).outlier_rates(outliers, OBSERVED, RATE).max()
        < 0.1
    )


def test_what_was_found_of_the_joint_before_counts(rng):
    outliers = (rng.random((1000, 3)) < RATE).astype(float)[:, [0, 0, 1]]
    joints, observed = np.array([0, 1, 2]), OBSERVED[:, :3]

    outlier_rates = JointOutlierPrior(joints, outliers).outlier_rates(outliers, observed, RATE)

    assert outlier_rates[outliers == 1.0].min() > 0.7
    assert outlier_rates[outliers == 0.0].max() < 0.5 * RATE


def test_the_first_and_the_last_channel_are_fellows_too(rng):
    outliers = (rng.random((1000, 1)) < RATE) * np.array([1.0, 0.0, 1.0])

    outlier_rates = JointOutlierPrior(np.zeros(3, dtype=int), NO_OUTLIERS[:, :3]).outlier_rates(
        outliers, OBSERVED[:, :3], RATE
    )

    assert outlier_rates[:, [0, 2]][outliers[:, [0, 2]] == 1.0].min() > 0.4


def test_nothing_known_is_no_error():
    outlier_rates = JointOutlierPrior(JOINTS, NO_OUTLIERS).outlier_rates(
        NO_OUTLIERS, OBSERVED & False, RATE
    )

    assert_allclose(outlier_rates, RATE)
