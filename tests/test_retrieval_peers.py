"""The benchmark of retrieval measures what it says, and its peers do what their names say."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.motion import Tracks, warp
from solvers.motion.humanoid.posture_joints import HIPS, POSTURE_JOINTS
from tests.benchmarks.peers.clip_alignment import warped_totals
from tests.benchmarks.peers.clip_statistics import Covariances
from tests.benchmarks.peers.complete_postures import learn_complete_postures, resampled
from tests.benchmarks.peers.motion_volumes import volume
from tests.benchmarks.peers.string_matching import common_fraction
from tests.benchmarks.retrieval.pyramid_methods import BODY, PARTS, only
from tests.benchmarks.retrieval.retrieval_clips import LabeledClip
from tests.benchmarks.retrieval.retrieval_damage import DAMAGES
from tests.benchmarks.retrieval.retrieval_fusion import Fused, manifold_ranking
from tests.benchmarks.retrieval.retrieval_methods import CUBES, METHODS, PUBLISHED, RANKED
from tests.benchmarks.retrieval.retrieval_protocol import answer, queries

LARGE = {PUBLISHED, CUBES, RANKED}
"""Methods that eight clips of two seconds teach nothing."""


def moving(rng, n_frames=90, speed=1.0):
    """An actor who stands and moves every joint by random waves."""
    time = np.arange(n_frames) / 120.0
    rest = np.zeros((20, 3))
    rest[:, 2] = [1.0, 1.2, 1.4, 1.7] + 2 * [1.4] * 4 + 2 * [1.0, 0.6, 0.1, 0.05]
    rest[4:8, 0], rest[8:12, 0] = [0.2, 0.4, 0.6, 0.7], [-0.2, -0.4, -0.6, -0.7]
    rest[12:16, 0], rest[16:20, 0] = 0.1, -0.1
    waves = rng.normal(scale=0.05, size=(20, 3))
    positions = rest + waves * np.sin(2.0 * np.pi * speed * time + 1.0)[:, None, None]
    return Tracks(POSTURE_JOINTS, positions, 120.0)


class ByNumber:
    """A method with fixed distances."""

    def __init__(self, distances):
        self.fixed_distances = distances

    def prepare(self, clips):
        return self

    def describe(self, tracks):
        return 0

    def distances(self, query, allowed):
        return np.array(self.fixed_distances, dtype=float)


def labeled(rng, labels, actors=None):
    actors = actors or ["a"] * len(labels)
    return [
        LabeledClip(str(index), label, actor, moving(rng))
        for index, (label, actor) in enumerate(zip(labels, actors, strict=True))
    ]


def test_precision_equals_that_of_a_hand_computed_order(rng):
    """Right, wrong, right, wrong: average precision (1 + 2/3) / 2; one of the first two."""
    library = labeled(rng, ["x", "y", "x", "y", "x"])
    requested = list(queries(library, library[4:], DAMAGES["clean"]))

    (found,) = answer(ByNumber([1, 2, 3, 4, 0]), library, requested)

    assert_allclose(found.precision, 5 / 6)
    assert_allclose(found.true_positives, 0.5)
    assert found.found == {"x": 0.5, "y": 0.5}
    assert_allclose(found.curve[[0, 10, 11, 20]], [1.0, 1.0, 2 / 3, 2 / 3])


def test_queries_exclude_their_own_clip_and_actor(rng):
    library = labeled(rng, ["x", "x", "x", "y"], ["a", "a", "b", "c"])

    alone = list(queries(library, library, DAMAGES["clean"]))
    others = list(queries(library, library, DAMAGES["clean"], other_actors=True))

    # y has no other clip of its class, and is no query.
    assert [each.allowed.tolist() for each in alone] == [
        [False, True, True, True], [True, False, True, True], [True, True, False, True],
    ]  # fmt: skip
    assert others[0].allowed.tolist() == [False, False, True, True]


@pytest.mark.parametrize(
    ("kind", "missing"), [("joints missing", 0.3), ("missing at random", 0.3)]
)
def test_damage_removes_the_stated_fraction(rng, kind, missing):
    tracks = moving(rng)
    damaged = DAMAGES[kind](tracks, rng)

    assert abs(1.0 - damaged.visible.mean() - missing) < 0.03
    assert tracks.visible.all()
    if kind == "joints missing":
        assert damaged.visible[:, HIPS].all()
        assert set(damaged.visible.mean(axis=0)) == {0.0, 1.0}


def test_faster_clip_is_shorter_on_the_same_path(rng):
    tracks = moving(rng)

    fast = DAMAGES["1.4x speed"](tracks, rng)

    assert fast.n_frames == int(89 / 1.4) + 1
    assert fast.frame_rate == 120.0
    assert_allclose(fast.positions[50], tracks.positions[70], atol=1e-4)


def test_warped_totals_equal_those_of_warp(rng):
    """All clips at once against the solver that the product uses for one pair."""
    query, lengths = rng.normal(size=(13, 3)), np.array([5, 13, 20])
    padded = rng.normal(size=(3, 20, 3))

    totals = warped_totals(query, padded, lengths)

    wanted = [
        warp(query, clip[:n]).distances.sum() for clip, n in zip(padded, lengths, strict=True)
    ]
    assert_allclose(totals, wanted)


def test_common_fraction_is_the_longest_common_substring():
    assert common_fraction((1, 2, 3, 4), (9, 2, 3, 8)) == 0.5
    assert common_fraction((1, 2), (3, 4)) == 0.0
    assert common_fraction((1, 2, 3), (1, 2, 3)) == 1.0


def test_volume_has_the_distances_of_joints(rng):
    frames = rng.normal(size=(12, 60))

    cube = volume(frames, 12)

    assert_allclose(cube[3, 7, 2], np.linalg.norm(frames[3, 6:9] - frames[7, 6:9]))


def test_resampling_keeps_ends_and_lines():
    line = np.arange(10.0)[:, None] * [1.0, -2.0]

    assert_allclose(resampled(line, 4), np.linspace(0.0, 9.0, 4)[:, None] * [1.0, -2.0])
    assert_allclose(resampled(line[:1], 3), np.zeros((3, 2)))


def test_covariances_equal_numpys(rng):
    frames = rng.normal(size=(40, 60))

    row = Covariances().descriptor(frames)

    upper = np.cov(frames[:, 3:].T)[np.triu_indices(57)]
    diagonal = np.equal(*np.triu_indices(57))
    assert_allclose(row[: len(upper)][diagonal], upper[diagonal])
    assert_allclose(row[: len(upper)][~diagonal], np.sqrt(2.0) * upper[~diagonal])


def test_missing_joints_are_predicted_from_the_others(rng):
    """Hands go where elbows go, in this library."""
    clips = [moving(rng) for _ in range(6)]
    clips = [replace(clip, positions=clip.positions.copy()) for clip in clips]
    for clip in clips:
        clip.positions[:, 6:8] = clip.positions[:, [5]] + [[0.2, 0.0, 0.0], [0.3, 0.0, 0.0]]
    complete, frames = learn_complete_postures(clips, 30.0)
    damaged = clips[0].positions.copy()
    damaged[:, 6:8] = np.nan

    made = complete(Tracks(POSTURE_JOINTS, damaged, 120.0))

    assert np.abs(made - frames[0]).max() < 0.03
    assert np.isnan(damaged[0, 6]).all()


def test_manifold_ranking_follows_the_chain(rng):
    """Points on a ring that nearly closes: the end is near by air and far along it."""
    angles = np.linspace(0.0, 1.9 * np.pi, 40)
    points = np.column_stack([np.cos(angles), np.sin(angles)])
    distances = np.linalg.norm(points[:, None] - points, axis=-1)

    ranking = manifold_ranking(distances, distances[0], 2)

    assert ranking[10] > ranking[20] > ranking[39]
    assert distances[0, 39] < distances[0, 10]


def test_fused_distances_are_sums_of_standard_scores(rng):
    one, other = ByNumber([1, 2, 3, 100]), ByNumber([40, 20, 60, -5])
    fused = Fused((one, other)).prepare([])
    allowed = np.array([True, True, True, False])

    distances = fused.distances(fused.describe(None), allowed)

    scores = [
        (np.array(each) - np.mean(each)) / np.std(each) for each in ([1, 2, 3], [40, 20, 60])
    ]
    assert_allclose(distances[:3], np.sum(scores, axis=0))


def test_pyramid_parts_are_relative_to_their_root(rng):
    from solvers.retrieval.postures.clip_postures import clip_postures

    postures = clip_postures(moving(rng))

    assert only(postures, *BODY[0]) is postures
    root, joints = PARTS[1]
    arm = only(postures, root, joints).positions
    assert_allclose(
        arm[:, joints[0]], postures.positions[:, joints[0]] - postures.positions[:, root]
    )
    assert not np.delete(arm, joints, axis=1).any()


@pytest.mark.parametrize("name", [name for name in METHODS if name not in LARGE])
def test_every_method_ranks_the_query_clip_first(name):
    """Eight actors with different random motions."""
    seeds = [np.random.default_rng(seed) for seed in range(8)]
    clips = [moving(each, 240, speed) for each, speed in zip(seeds, [1, 2] * 4, strict=True)]

    prepared = METHODS[name].prepare(clips)
    distances = prepared.distances(prepared.describe(clips[3]), np.ones(8, dtype=bool))

    assert distances.shape == (8,)
    assert np.argmin(distances) == 3
