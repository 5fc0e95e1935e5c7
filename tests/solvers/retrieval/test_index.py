"""Codewords, segments and posting lists, compared with simpler implementations."""

from dataclasses import fields, replace

import numpy as np
import pytest
from acted_clips import ACTS, act
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from solvers.motion.humanoid.posture_joints import POSTURE_JOINTS
from solvers.retrieval.index import index_block
from solvers.retrieval.index.clip_segments import (
    HISTOGRAM_SCALE,
    describe_clip_segments,
    segment_frames,
    weight_mean_posture,
)
from solvers.retrieval.index.index_block import (
    block_arrays,
    block_from_arrays,
    build_block,
    merge_blocks,
)
from solvers.retrieval.index.posting_lists import build_posting_lists
from solvers.retrieval.index.vocabulary import (
    learn_vocabulary,
    vocabulary_arrays,
    vocabulary_from_arrays,
)
from solvers.retrieval.postures.body_parts import BodyPart, part_coverage, part_features
from solvers.retrieval.postures.clip_postures import clip_postures

CLIPS = [clip_postures(act(name, 2.5), 20.0) for name in ACTS]


@pytest.fixture(scope="module")
def vocabulary():
    return learn_vocabulary(CLIPS)


@given(seed=st.integers(0, 500), maximum=st.sampled_from([10_000, 40, 1]))
def test_posting_lists_equal_a_matrix_product(seed, maximum):
    rng = np.random.default_rng(seed)
    histograms = (rng.integers(0, 255, (20, 12)) * (rng.random((20, 12)) < 0.3)).astype(
        np.uint8
    )
    query = (rng.random(12) * (rng.random(12) < 0.6)).astype(np.float32)
    lists = build_posting_lists(histograms)
    found = lists.scores(query, maximum)
    exact = histograms.astype(np.float32) @ query
    if maximum == 10_000:
        assert_allclose(found, exact, rtol=1e-5)
    assert (found <= exact + 1e-3).all()


def test_part_features_do_not_depend_on_other_parts():
    still, waving = act("wave", amount=0.0), act("wave")
    result = [
        part_features(observed.positions, observed.root_velocity, 30.0)
        for observed in (clip_postures(still), clip_postures(waving))
    ]
    moved = np.abs(result[1] - result[0]).max(axis=(0, 2))
    arm = list(BodyPart).index(BodyPart.RIGHT_ARM)
    assert moved[arm] > 0.3
    assert np.delete(moved, arm).max() < 1e-9


def test_coverage_is_the_fraction_of_tracked_joints():
    observed = np.ones((10, 20), bool)
    observed[:5, POSTURE_JOINTS.index("leftHand")] = False
    assert_allclose(part_coverage(observed), [1.0, 1.0 - 0.5 / 3.0, 1.0, 1.0, 1.0])


def test_codes_are_weights_of_the_nearest_words(vocabulary):
    features = vocabulary.features(CLIPS[0])
    codes = vocabulary.codes(features)
    assert_allclose(codes.sum(axis=-1), 1.0)
    assert ((codes > 0).sum(axis=-1) <= 3).all()
    distances = ((features[:, :, None] - vocabulary.words) ** 2).sum(axis=-1)
    assert_array_equal(codes.argmax(axis=-1), distances.argmin(axis=-1))


def test_vocabulary_repeats_and_survives_storage(vocabulary):
    again = learn_vocabulary(CLIPS)
    stored = vocabulary_from_arrays(vocabulary_arrays(vocabulary))
    for item in fields(vocabulary):
        if item.name != "posture_distribution":
            assert_array_equal(getattr(again, item.name), getattr(vocabulary, item.name))
            assert_array_equal(getattr(stored, item.name), getattr(vocabulary, item.name))
    assert_array_equal(
        stored.posture_distribution.covariance, vocabulary.posture_distribution.covariance
    )


def test_missing_joints_are_expected_at_their_positions(vocabulary):
    hidden = replace(CLIPS[1], positions=CLIPS[1].positions.copy())
    knee = POSTURE_JOINTS.index("leftLowerLeg")
    hidden.positions[10:40, knee] = np.nan
    filled = vocabulary.posture_distribution.fill_positions(hidden)
    assert np.abs(filled - CLIPS[1].positions).max() < 0.06
    assert_allclose(filled[:, :knee], CLIPS[1].positions[:, :knee], atol=1e-12)


def test_long_clips_have_segments_and_short_ones_a_single_one():
    assert_array_equal(segment_frames(80, 20.0), [[0, 80]])
    segments = segment_frames(240, 20.0)
    assert_array_equal(segments[0], [0, 240])
    lengths = set((segments[1:, 1] - segments[1:, 0]).tolist())
    assert lengths == {40, 80, 160}
    for length in lengths:
        starts = np.sort(segments[1:][segments[1:, 1] - segments[1:, 0] == length][:, 0])
        assert starts[0] == 0
        assert starts[-1] + length == 240
        assert np.diff(starts).max() <= length / 2 + 1


@pytest.mark.parametrize("n_frames", [1, 2, 81, 10_000])
def test_segments_lie_within_the_clip(n_frames):
    segments = segment_frames(n_frames, 20.0)
    assert (segments[:, 0] >= 0).all()
    assert (segments[:, 1] > segments[:, 0]).all()
    assert (segments[:, 1] <= n_frames).all()
    assert len(segments) <= 1 + n_frames / 10


def test_histograms_have_unit_length(vocabulary):
    segments = describe_clip_segments(CLIPS[3], vocabulary)
    lengths = np.linalg.norm(segments.histograms / HISTOGRAM_SCALE, axis=-1)
    assert_allclose(lengths, 1.0, atol=0.02)
    assert segments.summaries.shape == (1, 16, 5, 8)
    features = vocabulary.features(CLIPS[3])
    assert_allclose(segments.summaries[0, [0, -1]], features[[0, -1]], atol=2e-3)


def test_mean_posture_is_separate_from_movement():
    moves = np.random.default_rng(2).normal(size=(3, 16, 5, 8)).astype(np.float32)
    moves -= moves.mean(axis=1, keepdims=True)
    in_contact = 5.0 * np.ones((3, 1, 5, 8), dtype=np.float32)
    assert_allclose(weight_mean_posture(moves + in_contact, 0.0), moves, atol=1e-5)
    assert_allclose(weight_mean_posture(moves + in_contact, 0.4), moves + 2.0, atol=1e-5)
    assert_array_equal(weight_mean_posture(moves, 1.0), moves)


def test_halves_of_a_clip_are_distinguished(vocabulary):
    rising = CLIPS[1]
    rising = replace(
        rising, positions=rising.positions[:25], root_velocity=0.0 * rising.root_velocity[:25]
    )
    falling = replace(rising, positions=rising.positions[::-1])
    up, down = (
        describe_clip_segments(clip, vocabulary).histograms[0] / HISTOGRAM_SCALE
        for clip in (rising, falling)
    )
    legs = [list(BodyPart).index(part) for part in (BodyPart.LEFT_LEG, BodyPart.RIGHT_LEG)]
    similarities = np.einsum("pcw,pdw->cd", up[legs], down[legs]) / 2.0
    assert similarities[1, 2] > similarities[1, 1] + 0.1
    assert similarities[2, 1] > similarities[2, 2] + 0.04


def test_large_block_finds_the_same_best_segments(vocabulary, monkeypatch):
    block = build_block(
        list(range(5)), [describe_clip_segments(clip, vocabulary) for clip in CLIPS]
    )
    query = (block.histograms[2] / HISTOGRAM_SCALE).astype(np.float32)
    exact = block.similarities(query)
    monkeypatch.setattr(index_block, "MAX_POSTINGS", 300)
    monkeypatch.setattr(index_block, "N_EXACT_SEGMENTS", 2)
    rough = block.similarities(query)
    assert rough.argmax() == exact.argmax() == 2
    assert_allclose(np.sort(rough)[-2:], np.sort(exact)[-2:], rtol=1e-5)
    assert (rough <= exact + 1e-3).all()


def test_blocks_survive_storage_and_merging(vocabulary):
    described = [describe_clip_segments(clip, vocabulary) for clip in CLIPS]
    complete = build_block([1, 2, 3, 4, 5], described)
    n_words = vocabulary.words.shape[1]
    read = block_from_arrays(block_arrays(complete), n_words)
    together = merge_blocks(
        [build_block([1, 2], described[:2]), build_block([3, 4, 5], described[2:])],
        np.array([1, 2, 4, 5]),
    )
    remaining = complete.clips != 3
    query = (complete.histograms[0] / HISTOGRAM_SCALE).astype(np.float32)
    assert_array_equal(read.similarities(query), complete.similarities(query))
    assert_array_equal(together.clips, complete.clips[remaining])
    assert_array_equal(together.summaries, complete.summaries[remaining])
    assert_array_equal(together.similarities(query), complete.similarities(query)[remaining])


@pytest.mark.parametrize(
    ("column", "damage"),
    [
        ("spans", lambda raw: raw[:-4] + (2**30).to_bytes(4, "little")),
        ("spans", lambda raw: raw[:-4]),
        ("starts", lambda raw: raw[8:] + raw[:8]),
        ("histograms", lambda raw: raw[:-1]),
        ("frames", lambda raw: raw[:-2]),
        ("frames", lambda raw: bytes(8) + raw[8:]),
        ("frames", lambda raw: b"\xff" * 4 + raw[4:]),
        ("summaries", lambda raw: b"\x00\x7c" + raw[2:]),
    ],
)
def test_inconsistent_index_is_refused(vocabulary, column, damage):
    stored = block_arrays(build_block([1], [describe_clip_segments(CLIPS[0], vocabulary)]))
    stored[column] = damage(stored[column])
    with pytest.raises(ValueError):
        block_from_arrays(stored, vocabulary.words.shape[1])
