"""Outliers of one channel make those of its joint likely, if the take shows it."""

import numpy as np
from numpy.testing import assert_allclose

from solvers.denoising.posterior.joint_outliers import WholeJoints

JOINTS = np.array([0, 0, 0, 1, 2, 2])
RATE = 0.05
KNOWN = np.ones((1000, len(JOINTS)), dtype=bool)
NOWHERE = np.zeros(KNOWN.shape)


def test_joints_that_are_wrong_as_a_whole_are_known(rng):
    outside = (rng.random((1000, 3)) < RATE).astype(float)[:, JOINTS]

    rates = WholeJoints(JOINTS, NOWHERE).rates(outside, KNOWN, RATE)

    fellows = outside[:, [1, 0, 0, 3, 5, 4]] * [1, 1, 1, 0, 1, 1]
    has_fellows = JOINTS != 1
    assert rates[fellows == 1.0].min() > 0.7
    assert rates[:, has_fellows][fellows[:, has_fellows] == 0.0].max() < 0.5 * RATE
    assert_allclose(rates.mean(), RATE, rtol=0.3)


def test_channels_that_are_wrong_by_themselves_say_nothing(rng):
    outside = (rng.random((1000, 6)) < RATE).astype(float)

    rates = WholeJoints(JOINTS, NOWHERE).rates(outside, KNOWN, RATE)

    assert_allclose(rates, RATE, atol=0.03)


def test_few_outliers_prove_nothing():
    outside = np.zeros(KNOWN.shape)
    outside[500, :3] = 1.0

    assert WholeJoints(JOINTS, NOWHERE).rates(outside, KNOWN, RATE).max() < 0.1


def test_what_was_found_of_the_joint_before_counts(rng):
    outside = (rng.random((1000, 3)) < RATE).astype(float)[:, [0, 0, 1]]
    joints, known = np.array([0, 1, 2]), KNOWN[:, :3]

    rates = WholeJoints(joints, outside).rates(outside, known, RATE)

    assert rates[outside == 1.0].min() > 0.7
    assert rates[outside == 0.0].max() < 0.5 * RATE


def test_the_first_and_the_last_channel_are_fellows_too(rng):
    outside = (rng.random((1000, 1)) < RATE) * np.array([1.0, 0.0, 1.0])

    rates = WholeJoints(np.zeros(3, dtype=int), NOWHERE[:, :3]).rates(
        outside, KNOWN[:, :3], RATE
    )

    assert rates[:, [0, 2]][outside[:, [0, 2]] == 1.0].min() > 0.4


def test_nothing_known_is_no_error():
    rates = WholeJoints(JOINTS, NOWHERE).rates(NOWHERE, KNOWN & False, RATE)

    assert_allclose(rates, RATE)
