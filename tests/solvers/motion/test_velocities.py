"""Velocities are exact where finite differences are, also next to gaps."""

import numpy as np
from numpy.testing import assert_allclose

from solvers.motion import linear_velocities


def test_velocities_are_exact_for_constant_acceleration():
    time = np.arange(20) / 50.0
    positions = np.stack([3.0 * time**2, 2.0 * time, 0 * time], axis=-1)[:, None]

    velocities = linear_velocities(positions, 50.0)[:, 0]

    assert_allclose(velocities[1:-1, 0], 6.0 * time[1:-1], atol=1e-12)
    assert_allclose(velocities[:, 1], 2.0, atol=1e-12)


def test_ends_and_gap_boundaries_use_one_sided_differences():
    positions = np.arange(10.0)[:, None, None] ** 2 * np.ones(3)
    positions[4] = np.nan

    velocities = linear_velocities(positions, 1.0)[:, 0, 0]

    assert_allclose(velocities, [1, 2, 4, 5, np.nan, 11, 12, 14, 16, 17])


def test_single_frame_between_gaps_has_no_velocity():
    positions = np.zeros((5, 1, 3))
    positions[[1, 3]] = np.nan

    assert np.isnan(linear_velocities(positions, 30.0)[2]).all()


def test_single_frame_has_velocity_zero():
    assert_allclose(linear_velocities(np.ones((1, 2, 3)), 30.0), 0.0)
