"""Each step of the ranking, compared with a simpler implementation."""

import numpy as np
import pytest
from acted_clips import ACTS, act
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from reference_warping import plain_cost
from scipy.spatial.distance import cdist

from solvers import arrays
from solvers.motion.humanoid.posture_heading import rotate_about_vertical
from solvers.motion.humanoid.posture_joints import POSTURE_JOINTS
from solvers.retrieval import Clip, FindSettings, build_clip_library, find_similar
from solvers.retrieval.index import reranking, search_index
from solvers.retrieval.index.clip_segments import MEAN_POSTURE_WEIGHT, weight_mean_posture
from solvers.retrieval.index.index_block import IndexBlock
from solvers.retrieval.index.posting_lists import build_posting_lists
from solvers.retrieval.index.search_index import SearchIndex
from solvers.retrieval.index.vocabulary import learn_vocabulary
from solvers.retrieval.postures.body_parts import BodyPart
from solvers.retrieval.postures.clip_postures import ClipPostures, clip_postures
from solvers.retrieval.postures.mean_postures import learn_posture_distribution

RNG = np.random.default_rng(5)
BELIEVED, BLAMED = reranking.NEIGHBOR_WEIGHT, reranking.MAX_DISTANCE_RATIO


def block(clips, seed=0):
    rng = np.random.default_rng(seed)
    histograms = rng.integers(0, 255, (len(clips), 30)).astype(np.uint8)
    return IndexBlock(
        np.array(clips),
        rng.integers(0, 9, (len(clips), 2)).astype(np.int32),
        histograms,
        rng.normal(size=(len(clips), 16, 5, 8)).astype(np.float16),
        build_posting_lists(histograms),
    )


@given(seed=st.integers(0, 999))
def test_best_segment_of_each_clip_is_found(seed):
    rng = np.random.default_rng(seed)
    clips = [rng.integers(1, 6, size=size) for size in (4, 7)]
    alive = [rng.random(len(one)) < 0.8 for one in clips]
    index = SearchIndex(list(zip(map(block, clips), alive, strict=True)))
    distances = rng.integers(0, 5, 11).astype(np.float32)

    minimum, segments = index.best_segments(distances, [3])

    numbers, living = np.concatenate(clips), np.concatenate(alive)
    expected = [one for one in np.unique(numbers[living]) if one != 3]
    assert index.clips[segments].tolist() == expected
    for one, found, segment in zip(expected, minimum, segments, strict=True):
        assert living[segment]
        assert found == distances[segment] == distances[living & (numbers == one)].min()


def test_segments_are_loaded_from_their_blocks():
    first, second = block([1, 2, 3]), block([4, 5], seed=1)
    index = SearchIndex([(first, np.ones(3, bool)), (second, np.ones(2, bool))])
    steps = index.steps(np.array([4, 0, 3, 2]))
    assert_array_equal(steps[[0, 2]], second.summaries[[1, 0]].astype(np.float32))
    assert_array_equal(steps[[1, 3]], first.summaries[[0, 2]].astype(np.float32))


@pytest.mark.parametrize("at_once", [1, 300, arrays.MAX_BLOCK_VALUES])
def test_distances_of_clips_equal_the_plain_algorithm(at_once, monkeypatch):
    monkeypatch.setattr(arrays, "MAX_BLOCK_VALUES", at_once)
    sequences = RNG.normal(size=(5, 16, 3)).astype(np.float32)
    between = reranking.pairwise_warping_costs(sequences)
    for one, other in np.ndindex(5, 5):
        expected = plain_cost(cdist(sequences[one, ::2], sequences[other, ::2]))
        assert_allclose(between[one, other], expected, rtol=1e-4, atol=1e-3)


def test_only_small_libraries_cache_clip_distances(monkeypatch):
    index = SearchIndex([(block(range(6)), np.ones(6, bool))])
    segments = np.array([5, 1, 2])
    distances = index.pairwise_distances(segments)
    steps = weight_mean_posture(index.steps(segments), MEAN_POSTURE_WEIGHT)
    # Nothing is from itself but what single numbers leave of it.
    assert_allclose(
        distances, reranking.pairwise_warping_costs(steps.reshape(3, 16, 40)), atol=2e-3
    )
    monkeypatch.setattr(search_index, "MAX_BLOCK_VALUES", 35)
    assert index.pairwise_distances(segments) is None


def test_clips_are_reranked_by_their_nearest_neighbors():
    distances = RNG.random(9).astype(np.float32) + 0.5
    between = RNG.random((9, 9)).astype(np.float32)
    between += between.T
    others = [
        sorted(
            (other for other in range(9) if other != one), key=lambda other: between[one, other]
        )
        for one in range(9)
    ]
    nearest = [some[:3] for some in others]
    result = distances.astype(float)
    for _ in range(reranking.N_ROUNDS):
        before = result.copy()
        for one in range(9):
            voices = [
                1.0 + reranking.RECIPROCAL_WEIGHT * (one in nearest[other])
                for other in nearest[one]
            ]
            neighbor_mean = np.average(before[nearest[one]], weights=voices)
            result[one] = (before[one] + BELIEVED * neighbor_mean) / (1.0 + BELIEVED)
    expected = np.minimum(result, BLAMED * distances)
    assert_allclose(reranking.rerank_by_neighbors(distances, between, 3), expected, rtol=1e-5)


def test_reciprocal_neighbor_counts_more_than_another_one():
    """The first clip is among the two nearest of the second, but not of the third one."""
    values = np.array([0.0, 1.0, -1.1, -1.6, -1.7, 5.0], dtype=np.float32)
    between = np.abs(values[:, None] - values)
    first = [
        reranking.rerank_by_neighbors(np.array(distances, dtype=np.float32), between, 2)[0]
        for distances in ((1.0, 0.9, 1.1, 1.0, 1.0, 1.0), (1.0, 1.1, 0.9, 1.0, 1.0, 1.0))
    ]

    assert first[0] < first[1] - 0.01


def test_near_duplicate_of_the_query_stays_first():
    distances = np.array([0.05, 0.5, 0.52, 0.55], dtype=np.float32)
    between = np.array(
        [[0, 2, 2.1, 2.2], [2, 0, 0.1, 0.1], [2.1, 0.1, 0, 0.1], [2.2, 0.1, 0.1, 0]],
        dtype=np.float32,
    )
    assert reranking.rerank_by_neighbors(distances, between, 2).argmin() == 0


@pytest.mark.parametrize(
    "settings", [{}, {"n_warped": 0}, {"n_warped": 7}, {"n_neighbors": 0}, {"n_neighbors": 100}]
)
def test_number_of_ranked_clips_is_a_setting(settings):
    library = build_clip_library([
        Clip(f"{name} {number}", act(name, 2.0 + 0.1 * number))
        for name in ACTS
        for number in range(8)
    ])
    found = find_similar(act("kick"), library, settings=FindSettings(**settings, n_aligned=0))
    few = find_similar(
        act("kick"), library, settings=FindSettings(**settings, n_aligned=0, n_matches=5)
    )
    assert len({match.clip for match in found}) == len(found) == 8 * len(ACTS)
    assert [match.clip for match in few] == [match.clip for match in found[:5]]
    scores = [match.score for match in found]
    assert scores == sorted(scores, reverse=True)
    assert {match.clip.split()[0] for match in few} == {"kick"}


@pytest.mark.parametrize("angle", [-0.6, 0.3, 0.7])
def test_heading_of_incomplete_bodies_is_the_typical_one(angle):
    clips = [clip_postures(act(name, 2.5), 20.0) for name in ACTS]
    default, true = learn_posture_distribution(clips), clips[0]
    missing = [POSTURE_JOINTS.index(name) for name in ("leftUpperLeg", "rightUpperArm", "head")]
    positions = rotate_about_vertical(true.positions, np.full(true.n_frames, angle))
    positions[:, missing] = np.nan
    cos, sin = np.cos(angle), np.sin(angle)
    root_velocity = true.root_velocity.copy()
    root_velocity[:, :2] = root_velocity[:, :2] @ [[cos, sin], [-sin, cos]]

    found = default.fill_gaps(ClipPostures(positions, root_velocity, 20.0))

    observed = np.setdiff1d(np.arange(20), missing)
    assert np.abs(found.positions[:, observed] - true.positions[:, observed]).max() < 0.1
    assert (
        np.abs(found.root_velocity - true.root_velocity).max()
        < 0.2 * np.abs(true.root_velocity).max() + 1e-9
    )
    assert np.isfinite(found.positions).all()
    assert not np.isfinite(positions[:, missing]).any()


def test_moving_parts_weigh_more_than_hanging_arms():
    clips = [clip_postures(act(name, 2.5), 20.0) for name in ACTS]
    words = learn_vocabulary(clips)
    activity = words.activity(words.features(clip_postures(act("kick", 2.5), 20.0)))
    assert activity.argmax() == list(BodyPart).index(BodyPart.LEFT_LEG)

    weights = FindSettings().part_weights(np.ones(5), np.ones(5), activity)
    assert weights.argmax() == activity.argmax()
    assert weights.min() > 0.2
    assert_allclose(weights.mean(), 1.0)
    assert_allclose(FindSettings(busy=0.0).part_weights(np.ones(5), np.ones(5), activity), 1.0)


@pytest.mark.parametrize("activity", [np.zeros(5), np.array([0.0, 1e-9, 0.0, 1e-6, 0.0])])
def test_all_parts_of_a_pose_have_equal_weight(activity):
    weights = FindSettings().part_weights(np.ones(5), np.ones(5), activity)
    assert_allclose(weights, 1.0, atol=1e-3)


def test_excluded_parts_have_no_weight():
    settings = FindSettings(left_leg=False)
    weights = settings.part_weights(np.ones(5), np.ones(5), np.array([1.0, 1.0, 1.0, 9.0, 1.0]))
    assert_allclose(weights, [1.25, 1.25, 1.25, 0.0, 1.25])


def test_parts_at_rest_still_count():
    """A query that moves one hand is not answered by any clip that moves this hand."""
    weights = FindSettings().part_weights(
        np.ones(5), np.ones(5), np.array([0.0, 0.0, 0.0, 1.0, 0.0])
    )

    assert np.delete(weights, 3).min() > 0.1


def test_parts_that_were_hardly_tracked_hardly_count():
    reliability = np.array([1.0, 1.0, 1.0, 0.3, 1.0])

    weights = FindSettings().part_weights(np.ones(5), reliability, np.ones(5))

    assert weights[3] < 0.02
