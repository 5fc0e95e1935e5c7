"""Gaps are bridged along straight lines, and rotations evenly the short way."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.rotations.representations import quaternion_from_rotation_vector
from solvers.signals.linear_gaps import fill_gaps, fill_rotation_gaps


def test_a_straight_path_comes_back_whole(rng):
    start, speed = rng.normal(size=(2, 4, 3))
    path = start + np.arange(30.0)[:, None, None] * speed
    gapped = path.copy()
    gapped[5:12, 1] = gapped[20:, 2, 0:1] = np.nan
    gapped[15, 2] = np.nan

    made = fill_gaps(gapped)

    assert_allclose(made[:20], path[:20], atol=1e-12)
    assert_allclose(made[20:, 2], np.broadcast_to(path[19, 2], (10, 3)), atol=1e-12)


def test_what_is_known_stays_bit_for_bit_and_the_input_as_it_is(rng):
    values = rng.normal(size=(20, 3, 3))
    values[4:9, 0, 1] = np.nan
    before = values.copy()

    made = fill_gaps(values)

    known = np.isfinite(before).all(axis=-1)
    assert_array_equal(made[known], before[known])
    assert_array_equal(values, before)


def test_a_point_that_is_never_known_stays_unknown():
    values = np.ones((5, 2, 3))
    values[:, 1] = np.nan

    made = fill_gaps(values)

    assert np.isnan(made[:, 1]).all()
    assert (made[:, 0] == 1.0).all()


def test_what_is_not_believed_is_bridged_too():
    values = np.arange(6.0)[:, None] * np.ones(2)
    values[2:4] = 100.0
    known = np.array([True, True, False, False, True, True])

    made = fill_gaps(values, known)

    assert_allclose(made[:, 0], np.arange(6.0), atol=1e-12)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_rotations_turn_evenly_and_the_short_way(sign):
    """About one axis, bridging is the straight line of the angle."""
    angles = np.linspace(0.0, 2.0, 21)
    true = quaternion_from_rotation_vector(angles[:, None, None] * np.array([0.0, 0.0, 1.0]))
    gapped = true.copy()
    gapped[15:] *= sign
    gapped[5:15] = np.nan

    made = fill_rotation_gaps(gapped)

    close = np.abs((made * true).sum(axis=-1))
    assert_allclose(close, 1.0, atol=1e-12)


def test_rotations_hold_at_the_ends_and_rest_where_never_known():
    turned = quaternion_from_rotation_vector(np.array([0.3, 0.0, 0.0]))
    rotations = np.full((6, 2, 4), np.nan)
    rotations[2:4, 0] = turned

    made = fill_rotation_gaps(rotations)

    assert_allclose(made[:, 0], np.broadcast_to(turned, (6, 4)), atol=1e-12)
    assert_array_equal(made[:, 1], np.tile((1.0, 0.0, 0.0, 0.0), (6, 1)))
