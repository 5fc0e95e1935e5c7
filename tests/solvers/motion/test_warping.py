"""The alignment is optimal and lies within the requested band."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose, assert_array_equal

from solvers.errors import InvalidMotionError
from solvers.motion import warp

SMALL = st.integers(1, 6)
VALUES = st.floats(-10, 10, allow_nan=False)


@given(st.data())
def test_path_has_the_minimum_cost(data):
    """Compare with a recursion over all paths, on short sequences."""
    n, m = data.draw(SMALL), data.draw(SMALL)
    a = data.draw(arrays(float, (n, 2), elements=VALUES))
    b = data.draw(arrays(float, (m, 2), elements=VALUES))

    found = warp(a, b)

    assert_allclose(found.distances.sum(), min_total_cost(a, b), atol=1e-9)
    assert_allclose(found.cost, found.distances.mean())


@given(st.data())
def test_path_connects_both_ends_without_skipping(data):
    a = data.draw(arrays(float, (data.draw(SMALL), 1), elements=VALUES))
    b = data.draw(arrays(float, (data.draw(SMALL), 1), elements=VALUES))

    path = warp(a, b, data.draw(st.sampled_from([None, 0.0, 0.2, 1.0]))).path

    assert path[0].tolist() == [0, 0]
    assert path[-1].tolist() == [len(a) - 1, len(b) - 1]
    assert {tuple(step) for step in np.diff(path, axis=0)} <= {(0, 1), (1, 0), (1, 1)}


def test_sequence_has_cost_zero_to_itself(rng):
    a = rng.normal(size=(30, 5, 3))

    found = warp(a, a)

    assert found.cost == 0.0
    assert_array_equal(found.path, np.stack([np.arange(30)] * 2, axis=-1))


def test_path_recovers_a_change_of_tempo():
    """The same sine with a varying tempo: the path equals that tempo."""
    time = np.linspace(0, 1, 200)
    warped = time**1.6
    wave = np.stack([np.sin(9 * time), np.cos(5 * time)], axis=-1)
    played = np.stack([np.sin(9 * warped), np.cos(5 * warped)], axis=-1)

    found = warp(wave, played)

    assert found.cost < 0.05 * np.linalg.norm(wave - played, axis=-1).mean()
    assert np.abs(time[found.path[:, 0]] - warped[found.path[:, 1]]).max() < 0.02


def test_cost_is_symmetric(rng):
    a, b = rng.normal(size=(20, 3)), rng.normal(size=(27, 3))

    assert_allclose(warp(a, b).distances.sum(), warp(b, a).distances.sum())


def test_window_limits_the_path_to_the_diagonal(rng):
    a, b = rng.normal(size=(60, 3)), rng.normal(size=(60, 3))

    narrow = warp(a, b, window=0.05)

    assert np.abs(np.diff(narrow.path, axis=1)).max() <= 3
    assert narrow.distances.sum() >= warp(a, b).distances.sum()
    assert_allclose(warp(a, b, window=1.0).cost, warp(a, b).cost)


def test_window_of_size_zero_aligns_unequal_lengths(rng):
    found = warp(rng.normal(size=(10, 2)), rng.normal(size=(35, 2)), window=0.0)

    assert found.path[-1].tolist() == [9, 34]


def test_distance_is_the_mean_over_joints():
    a, b = np.zeros((1, 4, 3)), np.zeros((1, 4, 3))
    b[0, 1] = (3.0, 4.0, 0.0)

    assert warp(a, b).cost == 5.0 / 4.0


def test_missing_joints_are_excluded_from_the_mean():
    a, b = np.zeros((2, 2, 3)), np.ones((2, 2, 3))
    a[0, 1] = np.nan
    b[:, 1] = 50.0

    assert_allclose(warp(a[:1], b[:1]).cost, 3**0.5)


def test_warp_raises_for_incompatible_sequences(rng):
    a = rng.normal(size=(5, 3, 3))
    with pytest.raises(InvalidMotionError, match="the same joints"):
        warp(a, a[:, :2])
    with pytest.raises(InvalidMotionError, match="at least one frame"):
        warp(a, a[:0])
    with pytest.raises(InvalidMotionError, match="No two frames"):
        warp(a, np.full_like(a, np.nan))


def min_total_cost(a: np.ndarray, b: np.ndarray) -> float:
    @cache
    def total(i: int, j: int) -> float:
        here = float(np.linalg.norm(a[i] - b[j]))
        before = [
            total(p, q) for p, q in ((i - 1, j), (i, j - 1), (i - 1, j - 1)) if p >= 0 <= q
        ]
        return here + min(before, default=0.0)

    return total(len(a) - 1, len(b) - 1)
