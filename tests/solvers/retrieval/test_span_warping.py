"""Warping many at once gives what the plain dynamic programme gives for each."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from plain_warping import plain_cost
from scipy.spatial.distance import cdist

from solvers.retrieval.index.time_warping import frame_distances, warping_costs
from solvers.retrieval.search.align_clip import STEP_PENALTY, align_frames


@given(seed=st.integers(0, 999), n_steps=st.integers(1, 9), n_frames=st.integers(1, 9))
def test_costs_are_those_of_the_plain_programme(seed, n_steps, n_frames):
    rng = np.random.default_rng(seed)
    queries = rng.normal(size=(2, n_steps, 3)).astype(np.float32)
    sequences = rng.normal(size=(4, n_frames, 3)).astype(np.float32)
    apart = frame_distances(queries, sequences)
    costs = warping_costs(apart)
    assert costs.shape == (2, 4)
    for one, query in enumerate(queries):
        for other, sequence in enumerate(sequences):
            assert_allclose(apart[:, :, one, other], cdist(query, sequence), atol=2e-3)
            assert_allclose(costs[one, other], plain_cost(apart[:, :, one, other]), rtol=1e-4)


def test_distances_are_not_changed():
    apart = np.random.default_rng(0).random((5, 6, 3)).astype(np.float32)
    before = apart.copy()
    warping_costs(apart)
    np.testing.assert_array_equal(apart, before)


def plain_path_cost(query, clip):
    """The least cost of a path of the query through any part of the clip, tried one by one."""
    apart = cdist(query, clip)
    cost = np.full(apart.shape, np.inf)
    cost[0] = apart[0]
    for row in range(1, len(query)):
        for column in range(len(clip)):
            ways = [cost[row - 1, column] + STEP_PENALTY * apart[row, column]]
            if column:
                ways.append(cost[row - 1, column - 1] + apart[row, column])
                ways.append(cost[row, column - 1] + STEP_PENALTY * apart[row, column])
            cost[row, column] = min(ways)
    return cost[-1].min()


def cost_of(path, apart):
    steps = np.diff(path, axis=0).sum(axis=1)
    weights = np.r_[1.0, np.where(steps == 2, 1.0, STEP_PENALTY)]
    return float((weights * apart[path[:, 0], path[:, 1]]).sum())


@given(seed=st.integers(0, 999), n_query=st.integers(1, 8), n_clip=st.integers(1, 12))
def test_the_path_is_the_best_one_and_never_goes_back(seed, n_query, n_clip):
    rng = np.random.default_rng(seed)
    query, clip = rng.normal(size=(n_query, 3)), rng.normal(size=(n_clip, 3))
    path = align_frames(query, clip)
    steps = np.diff(path, axis=0)
    assert ((steps >= 0) & (steps <= 1)).all()
    assert (steps.sum(axis=1) > 0).all()
    assert path[0, 0] == 0
    assert path[-1, 0] == n_query - 1
    assert_allclose(cost_of(path, cdist(query, clip)), plain_path_cost(query, clip), rtol=1e-6)


@pytest.mark.parametrize("start", [0, 7, 30])
def test_a_cut_is_found_where_it_was_cut(start):
    clip = np.cumsum(np.random.default_rng(1).normal(size=(50, 4)), axis=0)
    path = align_frames(clip[start : start + 20], clip)
    np.testing.assert_array_equal(path, np.column_stack([np.arange(20), start + np.arange(20)]))
