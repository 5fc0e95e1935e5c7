"""Batched subsequence warping equals a plain dynamic program."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from reference_warping import plain_cost
from scipy.spatial.distance import cdist

from solvers.retrieval.index.time_warping import frame_distances, warping_costs
from solvers.retrieval.search.align_clip import STEP_PENALTY, align_frames


@given(seed=st.integers(0, 999), n_steps=st.integers(1, 9), n_frames=st.integers(1, 9))
def test_costs_equal_those_of_a_plain_dynamic_program(seed, n_steps, n_frames):
    rng = np.random.default_rng(seed)
    queries = rng.normal(size=(2, n_steps, 3)).astype(np.float32)
    sequences = rng.normal(size=(4, n_frames, 3)).astype(np.float32)
    distances = frame_distances(queries, sequences)
    costs = warping_costs(distances)
    assert costs.shape == (2, 4)
    for one, query in enumerate(queries):
        for other, sequence in enumerate(sequences):
            assert_allclose(distances[:, :, one, other], cdist(query, sequence), atol=2e-3)
            assert_allclose(
                costs[one, other], plain_cost(distances[:, :, one, other]), rtol=1e-4
            )


def test_distances_are_not_modified():
    distances = np.random.default_rng(0).random((5, 6, 3)).astype(np.float32)
    before = distances.copy()
    warping_costs(distances)
    np.testing.assert_array_equal(distances, before)


def plain_path_cost(query, clip):
    """Minimum cost of a path of the query through any segment of the clip, by exhaustive
    search.
    """
    distances = cdist(query, clip)
    cost = np.full(distances.shape, np.inf)
    cost[0] = distances[0]
    for row in range(1, len(query)):
        for column in range(len(clip)):
            candidates = [cost[row - 1, column] + STEP_PENALTY * distances[row, column]]
            if column:
                candidates.append(cost[row - 1, column - 1] + distances[row, column])
                candidates.append(cost[row, column - 1] + STEP_PENALTY * distances[row, column])
            cost[row, column] = min(candidates)
    return cost[-1].min()


def cost_of(path, distances):
    steps = np.diff(path, axis=0).sum(axis=1)
    weights = np.r_[1.0, np.where(steps == 2, 1.0, STEP_PENALTY)]
    return float((weights * distances[path[:, 0], path[:, 1]]).sum())


@given(seed=st.integers(0, 999), n_query=st.integers(1, 8), n_clip=st.integers(1, 12))
def test_path_is_optimal_and_monotonic(seed, n_query, n_clip):
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
def test_segment_is_found_at_its_start(start):
    clip = np.cumsum(np.random.default_rng(1).normal(size=(50, 4)), axis=0)
    path = align_frames(clip[start : start + 20], clip)
    np.testing.assert_array_equal(path, np.column_stack([np.arange(20), start + np.arange(20)]))
