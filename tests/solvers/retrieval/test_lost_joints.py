"""What is known of a query that lost joints, against plainer ways and against the whole."""

import numpy as np
import pytest
from acted import ACTS, act
from numpy.testing import assert_allclose, assert_array_equal

from solvers.motion.humanoid.posture_joints import PARENTS, POSTURE_JOINTS
from solvers.retrieval.postures.body_parts import JOINTS, ROOTS, BodyPart
from solvers.retrieval.postures.clip_postures import clip_postures
from solvers.retrieval.postures.mean_postures import (
    POSITION_NOISE_M,
    learn_posture_distribution,
)
from solvers.retrieval.postures.part_reliability import part_reliability

USUAL = learn_posture_distribution([clip_postures(act(name, 2.5), 20.0) for name in ACTS])
RIGHT_ARM = list(BodyPart).index(BodyPart.RIGHT_ARM)


def places(*names):
    return [POSTURE_JOINTS.index(name) for name in names]


def lost(tracks, *names):
    positions = tracks.positions.copy()
    positions[:, places(*names)] = np.nan
    return tracks.with_positions(positions)


def longer(tracks, joint, times):
    """Return an actor the bone to whose joint is longer; all that hangs on it moves along."""
    positions, moved = tracks.positions.copy(), {joint}
    for below, above in enumerate(PARENTS):
        if above in moved:
            moved.add(below)
    way = tracks.positions[:, joint] - tracks.positions[:, PARENTS[joint]]
    positions[:, sorted(moved)] += (times - 1.0) * way[:, None]
    return tracks.with_positions(positions)


@pytest.mark.parametrize("name", ACTS)
@pytest.mark.parametrize("times", [0.7, 1.5])
def test_an_actor_of_other_proportions_is_the_same_though_a_joint_is_lost(name, times):
    spine, chest, head = places("spine", "chest", "head")
    actor = longer(act(name), chest, times)
    whole = clip_postures(actor, 20.0)
    seen = clip_postures(lost(actor, "spine"), 20.0)

    found = USUAL.fill_gaps(seen).positions

    above = [spine, chest, head]
    assert np.abs(found - whole.positions)[:, above].max() < 0.05
    assert np.abs(seen.positions - whole.positions)[:, chest].max() > 0.03
    assert not np.isfinite(seen.positions[:, spine]).any()


@pytest.mark.parametrize("heading", [0.0, 2.0, -2.8])
def test_a_body_without_hips_and_shoulders_is_turned_whichever_way_it_faces(heading):
    names = ("chest", "head", "leftUpperArm", "leftUpperLeg", "rightUpperLeg")
    query = lost(act("kick", heading=heading), *names)
    found = USUAL.fill_gaps(clip_postures(query, 20.0)).positions
    assert_allclose(found, clip_postures(act("kick"), 20.0).positions, atol=0.15)


def test_short_gaps_cost_little_however_many_they_are():
    whole = act("kick", frame_rate=120.0)
    gone = np.random.default_rng(0).uniform(size=whole.positions.shape[:2]) < 0.3
    gaps = whole.with_positions(np.where(gone[..., None], np.nan, whole.positions))
    # At the ends nothing bridges.
    found, true = (clip_postures(one, 20.0).positions[2:-2] for one in (gaps, whole))
    assert_allclose(found, true, atol=0.01)


def test_long_gaps_stay():
    gap = act("kick", 3.0, 120.0)
    gap.positions[100:140, places("leftFoot")] = np.nan
    found = clip_postures(gap, 20.0).positions[:, places("leftFoot")[0], 0]
    assert_array_equal(np.flatnonzero(np.isnan(found)), np.arange(17, 24))


@pytest.mark.parametrize(
    "names", [["rightLowerArm"], ["rightHand", "rightHandEnd", "head"], ["leftFoot", "spine"]]
)
def test_reliability_is_what_is_left_when_the_rest_was_guessed(names):
    rng = np.random.default_rng(1)
    spread = USUAL.covariance + 1e-9 * np.eye(60)
    drawn = rng.multivariate_normal(np.zeros(60), spread, size=40_000).reshape(-1, 20, 3)
    seen = np.ones((8, 20), bool)
    seen[:, places(*names)] = False
    told = drawn[:, seen[0]].reshape(len(drawn), -1)
    told += POSITION_NOISE_M * rng.normal(size=told.shape)
    hidden = drawn[:, ~seen[0]].reshape(len(drawn), -1)
    guessed = np.zeros_like(drawn)
    guessed[:, ~seen[0]] = (
        hidden - told @ np.linalg.lstsq(told, hidden, rcond=None)[0]
    ).reshape(len(drawn), -1, 3)
    expected = [
        1.0 - _spread(guessed[:, joints] - guessed[:, [root]]) / _spread(true)
        for joints, root in zip(JOINTS, ROOTS, strict=True)
        if (true := drawn[:, joints] - drawn[:, [root]]) is not None
    ]
    assert_allclose(part_reliability(seen, USUAL), expected, atol=0.03)


def _spread(values):
    return (values**2).sum(axis=(1, 2)).mean()


def test_the_more_of_an_arm_is_lost_the_less_is_known_and_nothing_of_others():
    known = []
    for names in ([], ["rightLowerArm"], ["rightLowerArm", "rightHand", "rightHandEnd"]):
        seen = np.ones((10, 20), bool)
        seen[1:, places(*names)] = False
        known.append(part_reliability(seen, USUAL))
    assert_array_equal(known[0], 1.0)
    assert known[0][RIGHT_ARM] > known[1][RIGHT_ARM] > known[2][RIGHT_ARM] + 0.2
    assert_allclose(np.delete(known[2], RIGHT_ARM), 1.0)


def test_what_was_not_seen_at_all_is_hardly_known():
    assert (part_reliability(np.zeros((3, 20), bool), USUAL) <= 0.02).all()
