"""Gaps are interpolated linearly, and rotations along the shortest path."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.rotations.representations import quaternion_from_rotation_vector
from solvers.signals.linear_gaps import fill_gaps, fill_rotation_gaps


def test_straight_path_is_restored(rng):
    start, speed = rng.normal(size=(2, 4, 3))
    path = start + np.arange(30.0)[:, None, None] * speed
    gapped = path.copy()
    gapped[5:12, 1] = gapped[20:, 2, 0:1] = np.nan
    gapped[15, 2] = np.nan

    result = fill_gaps(gapped)

    assert_allclose(result[:20], path[:20], atol=1e-12)
    assert_allclose(result[20:, 2], np.broadcast_to(path[19, 2], (10, 3)), atol=1e-12)


def test_observed_values_and_the_input_stay_unchanged(rng):
    values = rng.normal(size=(20, 3, 3))
    values[4:9, 0, 1] = np.nan
    before = values.copy()

    result = fill_gaps(values)

    is_observed = np.isfinite(before).all(axis=-1)
    assert_array_equal(result[is_observed], before[is_observed])
    assert_array_equal(values, before)


def test_point_never_observed_stays_missing():
    values = np.ones((5, 2, 3))
    values[:, 1] = np.nan

    result = fill_gaps(values)

    assert np.isnan(result[:, 1]).all()
    assert (result[:, 0] == 1.0).all()


def test_unreliable_values_are_interpolated():
    values = np.arange(6.0)[:, None] * np.ones(2)
    values[2:4] = 100.0
    is_observed = np.array([True, True, False, False, True, True])

    result = fill_gaps(values, is_observed)

    assert_allclose(result[:, 0], np.arange(6.0), atol=1e-12)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_rotations_are_interpolated_evenly_on_the_shortest_path(sign):
    """About one axis, the angle is interpolated linearly."""
    angles = np.linspace(0.0, 2.0, 21)
    true = quaternion_from_rotation_vector(angles[:, None, None] * np.array([0.0, 0.0, 1.0]))
    gapped = true.copy()
    gapped[15:] *= sign
    gapped[5:15] = np.nan

    result = fill_rotation_gaps(gapped)

    close = np.abs((result * true).sum(axis=-1))
    assert_allclose(close, 1.0, atol=1e-12)


def test_rotations_hold_at_ends_and_are_identity_if_never_observed():
    rotated = quaternion_from_rotation_vector(np.array([0.3, 0.0, 0.0]))
    rotations = np.full((6, 2, 4), np.nan)
    rotations[2:4, 0] = rotated

    result = fill_rotation_gaps(rotations)

    assert_allclose(result[:, 0], np.broadcast_to(rotated, (6, 4)), atol=1e-12)
    assert_array_equal(result[:, 1], np.tile((1.0, 0.0, 0.0, 0.0), (6, 1)))
